#include "src/mpi/halo.hpp"

#include <algorithm>
#include <utility>

#include "src/mpi/box_tree.hpp"

namespace fiber {
namespace {

constexpr std::uint64_t segments_per_box = 8;
// Of a rank, for those near it to see which of theirs matter to it.
constexpr std::size_t coarse_boxes = 64;

/// The root of a rank's tree.
struct RankBox {
  SegmentBox around;
  bool has_segments = false;
};

/// Calls with each box's first segment and its nodes: call(first, nodes, count).
template <class Call>
void for_each_piece(const FiberRuns& own, const Call& call) {
  for (const FiberRun& run : own.runs) {
    for (std::uint64_t i = 0; i < run.count; i += segments_per_box) {
      call(GlobalSegment{run.first.fiber, run.first.segment + i}, own.nodes.data() + run.begin + i,
           std::min(segments_per_box, run.count - i));
    }
  }
}

PlainBox box_of_piece(const FiberNode* nodes, std::uint64_t count) {
  PlainBox box = box_around(nodes[0], nodes[1]);
  for (std::uint64_t i = 1; i < count; ++i) {
    box = merged(box, box_around(nodes[i], nodes[i + 1]));
  }
  return box;
}

/// In the order of for_each_piece().
std::vector<SegmentBox> boxes_of(const FiberRuns& own) {
  std::vector<SegmentBox> boxes;
  for_each_piece(own, [&](const GlobalSegment& first, const FiberNode* nodes, std::uint64_t count) {
    boxes.push_back({box_of_piece(nodes, count), first});
  });
  return boxes;
}

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
        may_come_within(mine.around.box, boxes[i].around.box, margin)) {
      neighbours.push_back(i);
    }
  }
  return neighbours;
}

// After everything of this rank.
constexpr GlobalSegment no_limit{~std::uint64_t{0}, ~std::uint64_t{0}};

/// What of this rank is near segments of another that are before it.
/// @param boxes_of_own its pieces'
FiberRuns segments_near(const FiberRuns& own, const std::vector<SegmentBox>& boxes_of_own,
                        const BoxTree& others, double margin) {
  FiberRuns near;
  auto box = boxes_of_own.begin();
  for_each_piece(own, [&](const GlobalSegment& first, const FiberNode* nodes, std::uint64_t count) {
    const GlobalSegment last{first.fiber, first.segment + count - 1};
    if (!others.has_near((box++)->box, margin, last)) {
      return;
    }
    std::uint64_t begin = 0;
    for (std::uint64_t i = 0; i <= count; ++i) {
      const bool is_near = i < count && others.has_near(box_around(nodes[i], nodes[i + 1]), margin,
                                                        {first.fiber, first.segment + i});
      if (!is_near) {
        if (begin < i) {
          near.add({first.fiber, first.segment + begin}, nodes + begin, i - begin);
        }
        begin = i + 1;
      }
    }
  });
  return near;
}

}  // namespace

FiberRuns find_halo(const Communicator& ranks, const FiberRuns& own, double margin) {
  const auto size = static_cast<std::size_t>(ranks.size());
  if (size == 1) {
    return {};
  }
  const std::vector<SegmentBox> boxes = boxes_of(own);
  const BoxTree tree(boxes);
  const std::vector<std::size_t> neighbours = find_neighbours(ranks, tree, margin);

  PerRank<SegmentBox> coarse(size);
  for (const std::size_t other : neighbours) {
    coarse[other] = tree.level_of_at_most(coarse_boxes);
  }
  coarse = ranks.exchange(coarse);

  // A neighbour needs those of my boxes that are near its own, to find what I need from it.
  PerRank<SegmentBox> fine(size);
  for (const std::size_t other : neighbours) {
    const BoxTree theirs(std::move(coarse[other]));
    for (const SegmentBox& box : tree.boxes()) {
      if (theirs.has_near(box.box, margin, no_limit)) {
        fine[other].push_back(box);
      }
    }
  }
  fine = ranks.exchange(fine);

  std::vector<FiberRuns> near(size);
  for (const std::size_t other : neighbours) {
    near[other] = segments_near(own, boxes, BoxTree(std::move(fine[other])), margin);
  }
  return exchange_runs(ranks, std::move(near));
}

}  // namespace fiber
