#include "src/mpi/halo.hpp"

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

}  // namespace

Halo::Halo(const Communicator& ranks, const FiberStates& own, const PieceBoxes& boxes,
           double margin)
    : runs_(ranks), nodes_(ranks), nodes_after_(ranks) {
  const auto size = static_cast<std::size_t>(ranks.size());
  if (size == 1) {
    return;
  }
  const BoxTree& tree = boxes.tree();
  const std::vector<std::size_t> neighbours = find_neighbours(ranks, tree, margin);

  PerRank<SegmentBox> coarse(size);
  for (const std::size_t other : neighbours) {
    coarse[other] = tree.level_of_at_most(coarse_boxes);
  }
  coarse = ranks.exchange(std::move(coarse));

  // A neighbour needs those of my pieces that are near its own, to find what I need from it.
  PerRank<SegmentBox> fine(size);
  PerRank<PieceCapsule> capsules(size);
  for (const std::size_t other : neighbours) {
    const BoxTree theirs(std::move(coarse[other]));
    std::vector<std::uint32_t> places;
    tree.for_each_near(theirs, margin,
                       [&](std::uint32_t place, const auto* /*first*/, const auto* /*last*/) {
                         places.push_back(place);
                       });
    fine[other].reserve(places.size());
    for (const std::uint32_t place : places) {
      fine[other].push_back(tree.box(place));
    }
    capsules[other] = boxes.capsules(own, places);
  }
  fine = ranks.exchange(std::move(fine));
  capsules = ranks.exchange(std::move(capsules));

  PerRank<FiberRun> runs(size);
  PerRank<FiberNode> nodes(size);
  PerRank<FiberNode> nodes_after(size);
  for (const std::size_t other : neighbours) {
    const NearPieces theirs{BoxTree(std::move(fine[other])), std::move(capsules[other])};
    FiberRuns near;
    FiberRuns near_after;
    boxes.for_each_near(own, theirs, margin,
                        [&](const FiberRun& run, std::uint64_t begin, std::uint64_t end) {
                          own.before.add_to(near, run, begin, end);
                          if (own.after != nullptr) {
                            own.after->add_to(near_after, run, begin, end);
                          }
                        });
    runs[other] = std::move(near.runs);
    nodes[other] = std::move(near.nodes);
    nodes_after[other] = std::move(near_after.nodes);
  }
  runs_.start(std::move(runs));
  nodes_.start(std::move(nodes));
  if (own.after != nullptr) {
    nodes_after_.start(std::move(nodes_after));
  }
}

FiberRuns Halo::take() {
  FiberRuns all;
  all.runs = joined_runs(runs_.finish());
  all.nodes = joined_nodes(nodes_.finish());
  return all;
}

}  // namespace fiber
