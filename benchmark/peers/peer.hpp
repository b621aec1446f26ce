#pragma once

#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Options of the engines of a benchmark.
struct BenchEngineOptions {
  std::uint32_t threads = 1;  ///< most threads to use, at least 1
  double margin = 0.0;        ///< [m] peers answer queries up to this one; >= 0, finite
};

/// The peer of this name, another library's broad phase in front of our narrow phase, or else the
/// engine. Peers answer QueryType::ALL only.
/// @throws std::invalid_argument for an unknown name, and for a peer this build is without, naming
///         the package to install
std::unique_ptr<ProximityEngine> make_bench_engine(const std::string& name,
                                                   const BenchEngineOptions& options = {});

/// Names of the peers in this build.
std::vector<std::string> peer_names();

/// Names of all peers, those this build is without among them.
std::vector<std::string> all_peer_names();

}  // namespace fiber
