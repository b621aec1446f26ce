#include "src/mpi/send_lists.hpp"

#include <algorithm>
#include <utility>

#include "src/mpi/box_tree.hpp"

namespace fiber {
namespace {

// Of a rank, for those near it to see which of theirs matter to it.
constexpr std::size_t coarse_boxes = 64;

/// The root of a rank's tree.
struct RankBox {
  PlainBox around;
  bool has_segments = false;
};

/// Other ranks whose segments may be near.
std::vector<std::size_t> find_neighbours(const Communicator& ranks, const BoxTree& tree,
                                         double margin) {
  RankBox mine;
  mine.has_segments = !tree.empty();
  if (mine.has_segments) {
    mine.around = tree.root();
  }
  const std::vector<RankBox> boxes = ranks.gather_all(mine);
  std::vector<std::size_t> neighbours;
  for (std::size_t i = 0; i < boxes.size(); ++i) {
    if (static_cast<int>(i) != ranks.rank() && mine.has_segments && boxes[i].has_segments &&
        may_come_within(mine.around, boxes[i].around, margin)) {
      neighbours.push_back(i);
    }
  }
  return neighbours;
}

/// [m] How much further than the margin to look. Room for several updates pays, as long as it is
/// small beside pieces: then the halo is little larger.
double room_for(const Communicator& ranks, double motion, const PieceBoxes& boxes) {
  constexpr double updates = 8.0;
  constexpr double most_of_piece = 0.1;
  const double most = most_of_piece * ranks.min(boxes.mean_side());
  const double per_update = 2.0 * motion;  // of two segments
  return per_update <= most ? std::min(updates * per_update, most) : 0.0;
}

}  // namespace

PerRank<RunSpan> find_send_lists(const Communicator& ranks, const FiberStates& own,
                                 const PieceBoxes& boxes, double margin) {
  const auto size = static_cast<std::size_t>(ranks.size());
  const BoxTree& tree = boxes.tree();
  const std::vector<std::size_t> neighbours = find_neighbours(ranks, tree, margin);

  PerRank<PlainBox> coarse(size);
  for (const std::size_t other : neighbours) {
    coarse[other] = tree.level_of_at_most(coarse_boxes);
  }
  coarse = ranks.exchange(std::move(coarse));

  // A neighbour needs those of my pieces that are near its own, to find what I need from it.
  PerRank<PlainBox> fine(size);
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

const PerRank<RunSpan>& SendLists::find(const Communicator& ranks, RankFibers& fibers,
                                        double margin) {
  if (ranks.size() == 1) {
    spans_.resize(1);
    return spans_;
  }
  const RankFibers::Displacement& now = fibers.displacement();
  // Both of two segments may have moved; a little more than the roundings of these sums.
  const double nearer = 2.0 * (1.0 + 0x1p-40) * (now.length - displacement_.length);
  if (now.epoch == displacement_.epoch && margin == margin_ && margin + nearer <= reach_) {
    return spans_;
  }
  ++search_count_;
  const PieceBoxes& boxes = fibers.fit_boxes();
  margin_ = margin;
  reach_ = (1.0 + 0x1p-50) * (margin + room_for(ranks, now.last, boxes));
  displacement_ = now;
  spans_ = find_send_lists(ranks, fibers.states(), boxes, reach_);
  return spans_;
}

}  // namespace fiber
