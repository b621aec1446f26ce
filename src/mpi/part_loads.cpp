#include "src/mpi/part_loads.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "src/mpi/box_tree.hpp"
#include "src/mpi/halo.hpp"
#include "src/mpi/named_fibers.hpp"
#include "src/mpi/partition.hpp"
#include "src/mpi/rank_fibers.hpp"

namespace fiber {
namespace {

// As in the search for halos.
constexpr std::uint64_t segments_per_counted_box = 8;

/// A few segments that follow each other.
struct CountedPiece {
  SegmentBox around;
  const FiberNode* nodes = nullptr;
  std::uint64_t count = 0;
};

std::vector<CountedPiece> counted_pieces(const FiberRuns& set) {
  std::vector<CountedPiece> pieces;
  pieces.reserve(set.nodes.size() / segments_per_counted_box + set.runs.size());
  for (const FiberRun& run : set.runs) {
    for (std::uint64_t i = 0; i < run.count; i += segments_per_counted_box) {
      const std::uint64_t count = std::min(segments_per_counted_box, run.count - i);
      const FiberNode* const nodes = set.nodes.data() + run.begin + i;
      PlainBox box = box_around(nodes[0], nodes[1]);
      for (std::uint64_t k = 1; k < count; ++k) {
        box = merged(box, box_around(nodes[k], nodes[k + 1]));
      }
      pieces.push_back({{box, {run.first.fiber, run.first.segment + i}}, nodes, count});
    }
  }
  return pieces;
}

BoxTree tree_of(const std::vector<CountedPiece>& pieces) {
  std::vector<SegmentBox> boxes;
  boxes.reserve(pieces.size());
  for (const CountedPiece& piece : pieces) {
    boxes.push_back(piece.around);
  }
  return BoxTree(std::move(boxes));
}

/// A part, as far as others need to know it.
struct PartBox {
  PlainBox box{};
  bool has_segments = false;

  bool is_near(const PartBox& other, double margin) const {
    return has_segments && other.has_segments && may_come_within(box, other.box, margin);
  }
};

struct CountedPart {
  std::vector<CountedPiece> pieces;
  BoxTree tree;
  PartBox around;

  explicit CountedPart(std::vector<CountedPiece> some)
      : pieces(std::move(some)), tree(tree_of(pieces)) {
    around.has_segments = !tree.empty();
    if (around.has_segments) {
      around.box = tree.root().box;
    }
  }
};

/// Adds the segments of other parts that this part needs.
void count_near(const std::vector<CountedPiece>& others, const BoxTree& part, double margin,
                PartLoad& load) {
  for (const CountedPiece& piece : others) {
    const GlobalSegment& first = piece.around.first;
    if (!part.has_near(piece.around.box, margin, {first.fiber, first.segment + piece.count - 1})) {
      continue;
    }
    bool goes_on = false;
    for (std::uint64_t i = 0; i < piece.count; ++i) {
      const bool is_near = part.has_near(box_around(piece.nodes[i], piece.nodes[i + 1]), margin,
                                         {first.fiber, first.segment + i});
      load.halo_segments += is_near ? 1 : 0;
      load.halo_runs += is_near && !goes_on ? 1 : 0;
      goes_on = is_near;
    }
  }
}

/// What each rank has, of all ranks in their order.
template <class T>
std::vector<T> joined(const Communicator& ranks, const std::vector<T>& mine) {
  std::vector<T> all;
  for (const std::vector<T>& some :
       ranks.exchange(PerRank<T>(static_cast<std::size_t>(ranks.size()), mine))) {
    all.insert(all.end(), some.begin(), some.end());
  }
  return all;
}

/// The pieces of some parts that follow each other, which this rank gets.
struct SharedParts {
  int first = 0;
  std::vector<FiberRuns> parts;
};

SharedParts deal_parts(const Communicator& ranks, const DistributedFibers& fibers, int parts) {
  RankFibers all;
  all.update(ranks, fibers.parts, fibers.names, 0.0);
  const NamedFibers& own = all.own();
  std::vector<PartitionObject> objects;
  objects.reserve(own.runs().size());
  for (const FiberRun& run : own.runs()) {
    objects.push_back({own.node(run.begin + run.count / 2).point, static_cast<float>(run.count)});
  }
  const std::vector<int> part_of = partition(ranks, objects, parts);
  const auto first_of = [&](int rank) {
    return static_cast<int>(std::int64_t{parts} * rank / ranks.size());
  };
  std::vector<int> rank_of(static_cast<std::size_t>(parts));
  for (int rank = 0; rank < ranks.size(); ++rank) {
    std::fill(rank_of.begin() + first_of(rank), rank_of.begin() + first_of(rank + 1), rank);
  }
  const auto size = static_cast<std::size_t>(ranks.size());
  std::vector<FiberRuns> to(size);
  PerRank<int> parts_to(size);
  for (std::size_t i = 0; i < own.runs().size(); ++i) {
    const FiberRun& run = own.runs()[i];
    const auto rank = static_cast<std::size_t>(rank_of[static_cast<std::size_t>(part_of[i])]);
    own.add_to(to[rank], run, 0, run.count);
    parts_to[rank].push_back(part_of[i]);
  }
  const FiberRuns got = exchange_runs(ranks, std::move(to));
  std::size_t next = 0;
  SharedParts shared;
  shared.first = first_of(ranks.rank());
  shared.parts.resize(static_cast<std::size_t>(first_of(ranks.rank() + 1) - shared.first));
  for (const std::vector<int>& some : ranks.exchange(std::move(parts_to))) {
    for (const int part : some) {
      const FiberRun& run = got.runs[next++];
      shared.parts[static_cast<std::size_t>(part - shared.first)].add(run,
                                                                      got.nodes.data() + run.begin);
    }
  }
  return shared;
}

FiberRuns all_of(const std::vector<FiberRuns>& parts) {
  FiberRuns all;
  for (const FiberRuns& part : parts) {
    for (const FiberRun& run : part.runs) {
      all.add(run, part.nodes.data() + run.begin);
    }
  }
  return all;
}

}  // namespace

std::vector<PartLoad> part_loads(const Communicator& ranks, const DistributedFibers& fibers,
                                 int parts, double margin) {
  const SharedParts shared = deal_parts(ranks, fibers, parts);
  NamedFibers all;
  all.assign(all_of(shared.parts));
  const FiberRuns remote = Halo(ranks, all, margin).take();
  const std::vector<CountedPiece> remote_pieces = counted_pieces(remote);
  std::vector<CountedPart> here;
  std::vector<PartBox> boxes_here;
  for (const FiberRuns& part : shared.parts) {
    here.emplace_back(counted_pieces(part));
    boxes_here.push_back(here.back().around);
  }
  const std::vector<PartBox> boxes = joined(ranks, boxes_here);
  std::vector<PartLoad> loads(here.size());
  for (std::size_t i = 0; i < here.size(); ++i) {
    PartLoad& load = loads[i];
    load.segments = shared.parts[i].segment_count();
    load.neighbours = static_cast<std::uint64_t>(
        std::count_if(boxes.begin(), boxes.end(),
                      [&](const PartBox& box) { return box.is_near(here[i].around, margin); }));
    load.neighbours -= here[i].around.has_segments ? 1 : 0;  // itself
    count_near(remote_pieces, here[i].tree, margin, load);
    for (std::size_t other = 0; other < here.size(); ++other) {
      if (other != i && here[other].around.is_near(here[i].around, margin)) {
        count_near(here[other].pieces, here[i].tree, margin, load);
      }
    }
  }
  return joined(ranks, loads);
}

}  // namespace fiber
