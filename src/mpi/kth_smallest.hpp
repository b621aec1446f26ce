#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// The order of pairs of all ranks: by distance or time, then by their segments.
struct PairKey {
  double value = 0.0;
  GlobalSegment a;
  GlobalSegment b;

  auto key() const { return std::tie(value, a.fiber, a.segment, b.fiber, b.segment); }
  bool operator<(const PairKey& other) const { return key() < other.key(); }
};

/// The k-th smallest key of all ranks, none if there are fewer. Collective.
/// @param keys of this rank
std::optional<PairKey> kth_smallest(const Communicator& ranks, std::uint64_t k,
                                    std::vector<PairKey> keys);

}  // namespace fiber
