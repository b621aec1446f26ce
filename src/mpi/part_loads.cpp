#include "src/mpi/part_loads.hpp"

#include <algorithm>
#include <numeric>
#include <utility>

#include "src/mpi/halo.hpp"
#include "src/mpi/named_fibers.hpp"
#include "src/mpi/partition.hpp"
#include "src/mpi/piece_boxes.hpp"
#include "src/mpi/rank_fibers.hpp"

namespace fiber {
namespace {

/// A part, as far as others need to know it.
struct PartBox {
  PlainBox box{};
  bool has_segments = false;

  bool is_near(const PartBox& other, double margin) const {
    return has_segments && other.has_segments && may_come_within(box, other.box, margin);
  }
};

struct CountedPart {
  NamedFibers fibers;
  PieceBoxes boxes;
  PartBox around;

  explicit CountedPart(const FiberRuns& set) {
    fibers.assign(set);
    boxes.update({fibers}, false);
    around.has_segments = !boxes.tree().empty();
    if (around.has_segments) {
      around.box = boxes.tree().root();
    }
  }

  /// Adds to what a part needs that has these pieces.
  void add_near(const NearPieces& part, double margin, PartLoad& load) const {
    boxes.for_each_near({fibers}, part, margin,
                        [&](std::uint32_t /*run*/, std::uint64_t begin, std::uint64_t end) {
                          load.halo_segments += end - begin;
                          load.halo_runs += 1;
                        });
  }
};

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
  all.update(ranks, fibers.parts, fibers.names);
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
  const CountedPart all(all_of(shared.parts));
  const CountedPart remote(
      Halo(ranks, {all.fibers}, spans_near_others(ranks, {all.fibers}, all.boxes, margin)).take());
  std::vector<CountedPart> here;
  std::vector<PartBox> boxes_here;
  for (const FiberRuns& part : shared.parts) {
    here.emplace_back(part);
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
    const NearPieces pieces = here[i].boxes.all({here[i].fibers});
    remote.add_near(pieces, margin, load);
    for (std::size_t other = 0; other < here.size(); ++other) {
      if (other != i && here[other].around.is_near(here[i].around, margin)) {
        here[other].add_near(pieces, margin, load);
      }
    }
  }
  return joined(ranks, loads);
}

}  // namespace fiber
