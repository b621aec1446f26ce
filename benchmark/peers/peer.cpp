#include "benchmark/peers/peer.hpp"

#include <cassert>
#include <cmath>
#include <stdexcept>

#include "benchmark/peers/makers.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

struct Peer {
  const char* name;
  const char* packages;  // of Debian
  PeerMaker make;        // null: not in this build
};

constexpr const char* embree_packages = "libembree-dev";
constexpr const char* fcl_packages = "libfcl-dev";
constexpr Peer peers[] = {
    {"bullet", "libbullet-dev", make_bullet},
    {"cgal", "libcgal-dev", make_cgal},
    {"embree_low", embree_packages, make_embree_low},
    {"embree_medium", embree_packages, make_embree_medium},
    {"embree_refit", embree_packages, make_embree_refit},
    {"fcl", fcl_packages, make_fcl},
    {"fcl_naive", fcl_packages, make_fcl_naive},
};

std::string all_peers() {
  std::string list;
  for (const std::string& name : all_peer_names()) {
    list += (list.empty() ? "" : ", ") + name;
  }
  return list;
}

}  // namespace

std::unique_ptr<ProximityEngine> make_bench_engine(const std::string& name,
                                                   const BenchEngineOptions& options) {
  assert(options.threads > 0 && options.margin >= 0.0 && std::isfinite(options.margin));
  validate_threads(options.threads);
  for (const Peer& peer : peers) {
    if (name != peer.name) {
      continue;
    }
    if (peer.make == nullptr) {
      throw std::invalid_argument("this build is without the peer '" + name + "': install " +
                                  peer.packages + " (scripts/setup.sh --bench), then build again");
    }
    return peer.make(options);
  }
  try {
    return make_engine(name, {options.threads, 0.0});
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(std::string(error.what()) + "; peers are: " + all_peers());
  }
}

std::vector<std::string> peer_names() {
  std::vector<std::string> names;
  for (const Peer& peer : peers) {
    if (peer.make != nullptr) {
      names.emplace_back(peer.name);
    }
  }
  return names;
}

std::vector<std::string> all_peer_names() {
  std::vector<std::string> names;
  for (const Peer& peer : peers) {
    names.emplace_back(peer.name);
  }
  return names;
}

}  // namespace fiber
