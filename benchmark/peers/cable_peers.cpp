#include "benchmark/peers/cable_peers.hpp"

namespace fiber {
namespace {

using Methods = decltype(bullet_ropes);

struct CablePeer {
  const char* name;
  const char* package;  // of Debian
  Methods* methods;     // null: not in this build
};

constexpr CablePeer peers[] = {
#ifdef FIBER_BENCH_HAS_BULLET_ROPE
    {"Bullet", "libbullet-dev", bullet_ropes},
#else
    {"Bullet", "libbullet-dev", nullptr},
#endif
#ifdef FIBER_BENCH_HAS_MUJOCO
    {"MuJoCo", "libmujoco-dev", mujoco_chains},
#else
    {"MuJoCo", "libmujoco-dev", nullptr},
#endif
};

}  // namespace

std::vector<CableMethod> peer_cables(const CableScene& scene, const std::vector<int>& segments) {
  std::vector<CableMethod> methods;
  for (const CablePeer& peer : peers) {
    if (peer.methods != nullptr) {
      for (CableMethod& method : peer.methods(scene, segments)) {
        methods.push_back(std::move(method));
      }
    }
  }
  return methods;
}

std::vector<std::string> missing_cable_peers() {
  std::vector<std::string> lines;
  for (const CablePeer& peer : peers) {
    if (peer.methods == nullptr) {
      lines.push_back(std::string("this build is without ") + peer.name +
                      ", which is left out: install " + peer.package +
                      " (scripts/setup.sh --bench), then build again");
    }
  }
  return lines;
}

}  // namespace fiber
