#pragma once

#include <cstdint>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_states.hpp"
#include "src/mpi/piece_boxes.hpp"
#include "src/mpi/rank_fibers.hpp"

namespace fiber {

/// Segments of one run of a rank's own: begin … end - 1 along it.
struct RunSpan {
  std::uint32_t run = 0;
  std::uint64_t begin = 0;
  std::uint64_t end = 0;
};

/// By rank the segments of this one that may come within the margin [m] of one of the other's that
/// is before them in the order of contacts, by what is around a few segments that follow each
/// other. Collective.
/// @param own   of fibres that move the ways to where they are after that count
/// @param boxes of own
PerRank<RunSpan> find_send_lists(const Communicator& ranks, const FiberStates& own,
                                 const PieceBoxes& boxes, double margin);

/// The same for queries one after another: found with some room, they serve until points have moved
/// that far.
class SendLists {
 public:
  /// Finds lists, or has some that serve. Collective.
  const PerRank<RunSpan>& find(const Communicator& ranks, RankFibers& fibers, double margin);

  /// How often none served.
  std::uint64_t search_count() const { return search_count_; }

 private:
  PerRank<RunSpan> spans_;
  double margin_ = 0.0;  // [m] that they are for
  double reach_ = -1.0;  // [m] and that they were found with; nothing comes within less than 0
  RankFibers::Displacement displacement_;
  std::uint64_t search_count_ = 0;
};

}  // namespace fiber
