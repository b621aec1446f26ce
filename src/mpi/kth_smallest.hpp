#pragma once

#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// What decides which pair comes first, as it travels: a distance or a time, then the segments.
struct PairKey {
  double value = 0.0;
  GlobalSegment a;
  GlobalSegment b;

  auto key() const { return std::tie(value, a.fiber, a.segment, b.fiber, b.segment); }
  bool operator<(const PairKey& other) const { return key() < other.key(); }
};

/// The last one of the so many first ones of all ranks; none if there are fewer. Collective.
/// @param places of this rank, at least its so many first ones
std::optional<PairKey> kth_smallest(const Communicator& ranks, std::uint64_t count,
                                    std::vector<PairKey> places);

}  // namespace fiber
