#pragma once

#include <cstdint>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_states.hpp"
#include "src/mpi/owned_fibers.hpp"
#include "src/mpi/piece_boxes.hpp"

namespace fiber {

/// Segments of one run of a rank's own: begin … end - 1 along it.
struct RunSpan {
  std::uint32_t run = 0;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// Finds what this rank must send to each other one: its segments that may come within the margin
/// [m] of a segment of the other that is before them in the order of contacts. Decided by boxes and
/// capsules around a few consecutive segments. Collective.
/// @param own   this rank's fibres; where they move, during the whole motion
/// @param boxes of own
PerRank<RunSpan> find_send_lists(const Communicator& ranks, const FiberStates& own,
                                 const PieceBoxes& boxes, double margin);

/// Send lists that serve several queries: they are found with some room, and serve until points
/// have moved that far.
class SendLists {
 public:
  /// The send list of each rank, found now or before. Collective.
  const PerRank<RunSpan>& find(const Communicator& ranks, OwnedFibers& fibers, double margin);

  /// How often none served.
  std::uint64_t search_count() const { return search_count_; }

 private:
  PerRank<RunSpan> spans_;
  double margin_ = 0.0;  // [m] that they are for
  double reach_ = -1.0;  // [m] and that they were found with; nothing comes within less than 0
  Displacement found_at_;
  std::uint64_t search_count_ = 0;
};

}  // namespace fiber
