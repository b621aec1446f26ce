#include "src/mpi/send_lists.hpp"

#include <algorithm>
#include <utility>

#include "src/mpi/box_tree.hpp"

namespace fiber {
namespace {

// So many boxes a rank shows its neighbours, for them to see which of their segments matter to it.
constexpr std::size_t coarse_boxes = 64;

/// Other ranks whose segments may be near.
std::vector<std::size_t> find_neighbours(const Communicator& ranks, const BoxTree& tree,
                                         double margin) {
  const Box3d own = tree.empty() ? Box3d() : tree.root();
  const std::vector<Box3d> boxes = ranks.gather_all(own);
  std::vector<std::size_t> neighbours;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (static_cast<int>(i) != ranks.rank() && !own.isEmpty() && !boxes[i].isEmpty() &&
        may_come_within(own, boxes[i], margin)) {
      neighbours.push_back(i);
    }
  }
  return neighbours;
}

/// [m] How much further than the margin to look. Room for several updates pays, as long as it is
/// small beside pieces: then the halo is little larger.
double room_for(const Communicator& ranks, double motion, const PieceBoxes& boxes) {
  constexpr double updates = 8.0;
  constexpr double max_part_of_piece = 0.1;
  const double max_room = max_part_of_piece * ranks.min(boxes.mean_side());
  const double per_update = 2.0 * motion;  // of two segments
  return per_update <= max_room ? std::min(updates * per_update, max_room) : 0.0;
}

}  // namespace

PerRank<RunSpan> find_send_lists(const Communicator& ranks, const FiberStates& own,
                                 const PieceBoxes& boxes, double margin) {
  const auto size = static_cast<std::size_t>(ranks.size());
  const BoxTree& tree = boxes.tree();
  const std::vector<std::size_t> neighbours = find_neighbours(ranks, tree, margin);

  PerRank<Box3d> coarse(size);
  for (const std::size_t other : neighbours) {
    coarse[other] = tree.level_of_at_most(coarse_boxes);
  }
  coarse = ranks.exchange(std::move(coarse));

  // A neighbour needs those of my pieces that are near its own, to find what I need from it.
  PerRank<Box3d> fine(size);
  PerRank<NearPiece> pieces(size);
  for (const std::size_t other : neighbours) {
    const BoxTree theirs(coarse[other]);
    std::vector<std::uint32_t> places;
    tree.for_each_near(theirs, margin,
                       [&](std::uint32_t place, const auto* /*first*/, const auto* /*last*/) {
                         places.push_back(place);
                       });
    fine[other].reserve(places.size());
    for (const std::uint32_t place : places) {
      fine[other].push_back(tree.box(place));
    }
    pieces[other] = boxes.pieces(own, places);
  }
  fine = ranks.exchange(std::move(fine));
  pieces = ranks.exchange(std::move(pieces));

  PerRank<RunSpan> spans(size);
  for (const std::size_t other : neighbours) {
    const NearPieces theirs{BoxTree(fine[other]), std::move(pieces[other])};
    boxes.for_each_near(own, theirs, margin,
                        [&](std::uint32_t run, std::uint64_t begin, std::uint64_t end) {
                          spans[other].push_back({run, begin, end});
                        });
  }
  return spans;
}

const PerRank<RunSpan>& SendLists::find(const Communicator& ranks, OwnedFibers& fibers,
                                        double margin) {
  if (ranks.size() == 1) {
    spans_.resize(1);
    return spans_;
  }
  const Displacement& now = fibers.displacement();
  // Both of two segments may have moved; a little more than the roundings of these sums.
  const double nearer = 2.0 * (1.0 + 0x1p-40) * (now.length - found_at_.length);
  if (now.epoch == found_at_.epoch && margin == margin_ && margin + nearer <= reach_) {
    return spans_;
  }
  ++search_count_;
  const PieceBoxes& boxes = fibers.fit_boxes();
  margin_ = margin;
  reach_ = (1.0 + 0x1p-50) * (margin + room_for(ranks, now.last, boxes));
  found_at_ = now;
  spans_ = find_send_lists(ranks, fibers.states(), boxes, reach_);
  return spans_;
}

}  // namespace fiber
