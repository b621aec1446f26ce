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

/// A few segments of a run that a box is around.
struct Piece {
  const FiberRun& run;
  std::uint64_t begin;  // along the run
  std::uint64_t count;

  GlobalSegment name_of(std::uint64_t i) const {
    return {run.first.fiber, run.first.segment + begin + i};
  }
  std::uint64_t point(std::uint64_t i) const { return run.begin + begin + i; }
};

template <class Call>
void for_each_piece(const NamedFibers& own, const Call& call) {
  for (const FiberRun& run : own.runs()) {
    for (std::uint64_t i = 0; i < run.count; i += segments_per_box) {
      call(Piece{run, i, std::min(segments_per_box, run.count - i)});
    }
  }
}

PlainBox box_of(const NamedFibers& own, const Piece& piece, std::uint64_t i) {
  return box_around(own.node(piece.point(i)), own.node(piece.point(i + 1)));
}

PlainBox box_of(const NamedFibers& own, const Piece& piece) {
  PlainBox box = box_of(own, piece, 0);
  for (std::uint64_t i = 1; i < piece.count; ++i) {
    box = merged(box, box_of(own, piece, i));
  }
  return box;
}

/// In the order of for_each_piece().
std::vector<SegmentBox> boxes_of(const NamedFibers& own) {
  std::vector<SegmentBox> boxes;
  boxes.reserve(own.fibers().segment_count() / segments_per_box + own.runs().size());
  for_each_piece(own, [&](const Piece& piece) {
    boxes.push_back({box_of(own, piece), piece.name_of(0)});
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
/// @param boxes of its pieces
FiberRuns segments_near(const NamedFibers& own, const std::vector<SegmentBox>& boxes,
                        const BoxTree& others, double margin) {
  FiberRuns near;
  auto box = boxes.begin();
  for_each_piece(own, [&](const Piece& piece) {
    if (!others.has_near((box++)->box, margin, piece.name_of(piece.count - 1))) {
      return;
    }
    std::uint64_t begin = 0;
    for (std::uint64_t i = 0; i <= piece.count; ++i) {
      const bool is_near =
          i < piece.count && others.has_near(box_of(own, piece, i), margin, piece.name_of(i));
      if (!is_near) {
        if (begin < i) {
          own.add_to(near, piece.run, piece.begin + begin, piece.begin + i);
        }
        begin = i + 1;
      }
    }
  });
  return near;
}

}  // namespace

Halo::Halo(const Communicator& ranks, const NamedFibers& own, double margin)
    : runs_(ranks), nodes_(ranks) {
  const auto size = static_cast<std::size_t>(ranks.size());
  if (size == 1) {
    return;
  }
  const std::vector<SegmentBox> boxes = boxes_of(own);
  const BoxTree tree(boxes);
  const std::vector<std::size_t> neighbours = find_neighbours(ranks, tree, margin);

  PerRank<SegmentBox> coarse(size);
  for (const std::size_t other : neighbours) {
    coarse[other] = tree.level_of_at_most(coarse_boxes);
  }
  coarse = ranks.exchange(std::move(coarse));

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
  fine = ranks.exchange(std::move(fine));

  PerRank<FiberRun> runs(size);
  PerRank<FiberNode> nodes(size);
  for (const std::size_t other : neighbours) {
    FiberRuns near = segments_near(own, boxes, BoxTree(std::move(fine[other])), margin);
    runs[other] = std::move(near.runs);
    nodes[other] = std::move(near.nodes);
  }
  runs_.start(std::move(runs));
  nodes_.start(std::move(nodes));
}

FiberRuns Halo::take() {
  FiberRuns all;
  all.runs = joined_runs(runs_.finish());
  all.nodes = joined_nodes(nodes_.finish());
  return all;
}

}  // namespace fiber
