// What would be held by more ranks than there are, beside what they hold.
#include "src/mpi/part_loads.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "src/mpi/partition.hpp"
#include "test/mpi/dealt_fibers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/dense_fibers.hpp"
#include "test/support/hard_scenes.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

/// Of the first so many ranks; the others have none.
class SomeRanks {
 public:
  explicit SomeRanks(int count) {
    MPI_Comm_split(MPI_COMM_WORLD, own_rank() < count ? 0 : MPI_UNDEFINED, own_rank(), &ranks_);
  }
  ~SomeRanks() {
    if (is_in()) {
      MPI_Comm_free(&ranks_);
    }
  }
  SomeRanks(const SomeRanks&) = delete;
  SomeRanks& operator=(const SomeRanks&) = delete;

  bool is_in() const { return ranks_ != MPI_COMM_NULL; }
  MPI_Comm handle() const { return ranks_; }

 private:
  MPI_Comm ranks_ = MPI_COMM_NULL;
};

/// What some ranks say that all would hold. The first of them brings all fibres, each whole: where
/// they are cut, pieces begin.
std::vector<PartLoad> planned_by(int count, const FiberAssembly& fibers, double margin) {
  const SomeRanks some(count);
  if (!some.is_in()) {
    return {};
  }
  const Communicator ranks(some.handle());
  const std::vector<DealtPart> dealt = [&] {
    std::vector<DealtPart> parts;
    for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
      parts.push_back({fiber, 0, fibers.offsets()[fiber + 1] - fibers.offsets()[fiber] - 1, 0});
    }
    return parts;
  }();
  const DistributedFibers mine = dealt_to(own_rank(), fibers, dealt);
  return part_loads(ranks, {mine.parts, mine.names}, rank_count(), margin);
}

/// Own segments and those of the halo, of each rank or part: their numbers may differ.
using Held = std::vector<std::pair<std::uint64_t, std::uint64_t>>;

Held sorted(Held held) {
  std::sort(held.begin(), held.end());
  return held;
}

Held held_by(const std::vector<PartLoad>& loads) {
  Held held;
  for (const PartLoad& load : loads) {
    held.emplace_back(load.segments, load.halo_segments);
  }
  return held;
}

/// By the engines of all ranks, as they say themselves.
Held held_by_ranks(const FiberAssembly& fibers, double margin, Random& random) {
  const DistributedFibers mine = dealt_to(own_rank(), fibers, deal(fibers, 0, random));
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  engine.update(mine.parts, mine.names);
  DistributedResult result;
  engine.query(within(margin), result);
  Held held;
  for (const DistributedFacts& facts : Communicator(MPI_COMM_WORLD).gather_all(engine.facts())) {
    held.emplace_back(facts.own_segments, facts.halo_segments);
  }
  return held;
}

TEST(Partition, DoesNotCutWhatIsFlatIntoSlices) {
  const Communicator ranks(MPI_COMM_WORLD);
  Random random(static_cast<std::uint64_t>(own_rank()) + 1);
  std::vector<PartitionObject> objects;
  for (int i = 0; i < 4000 / rank_count(); ++i) {
    objects.push_back(
        {{random.uniform(0.0, 1.0), random.uniform(0.0, 1.0), random.uniform(0.0, 0.01)}});
  }
  const std::vector<int> parts = partition(ranks, objects, 16);
  for (int part = 0; part < 16; ++part) {
    PlainPoint lower{1.0, 1.0, 1.0};
    PlainPoint upper{0.0, 0.0, 0.0};
    for (std::size_t i = 0; i < objects.size(); ++i) {
      for (std::size_t axis = 0; axis < 3 && parts[i] == part; ++axis) {
        lower[axis] = std::min(lower[axis], objects[i].centre[axis]);
        upper[axis] = std::max(upper[axis], objects[i].centre[axis]);
      }
    }
    EXPECT_GT(ranks.largest(upper[2]) - ranks.smallest(lower[2]), 0.009) << "part " << part;
  }
}

TEST(PartLoads, AreThoseOfAsManyRanks) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::vector<AssemblyFamily> families = assembly_families();
  for (const std::vector<AssemblyFamily>& more : {dense_families(), hard_scenes()}) {
    families.insert(families.end(), more.begin(), more.end());
  }
  std::uint64_t halo = 0;
  for (const AssemblyFamily& family : families) {
    for (int round = 0; round < rounds(3); ++round) {
      const FiberAssembly fibers = family.make(random);
      const double margin = extent_of(fibers) * std::pow(10.0, random.uniform(-4.0, -1.0));
      const Held expected = sorted(held_by_ranks(fibers, margin, random));
      for (int count = 1; count <= rank_count(); ++count) {
        const std::vector<PartLoad> loads = planned_by(count, fibers, margin);
        if (own_rank() < count) {
          EXPECT_EQ(sorted(held_by(loads)), expected)
              << family.name << ", planned by " << count << " ranks";
        }
        for (const PartLoad& load : loads) {
          EXPECT_TRUE(load.neighbours > 0 || load.halo_segments == 0);
          EXPECT_LE(load.halo_runs, load.halo_segments);
          EXPECT_LE(load.halo_segments, 8 * load.halo_runs);
          halo += load.halo_segments;
        }
      }
    }
  }
  if (rank_count() > 1) {
    expect_enough(static_cast<int>(halo), 1000 / rounds_less);
  }
}

}  // namespace
}  // namespace fiber::test
