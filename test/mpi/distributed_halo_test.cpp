// What ranks hold: their share, and of others what may be near.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "test/mpi/dealt_fibers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"

namespace fiber::test {
namespace {

std::uint64_t over_ranks(std::uint64_t value, MPI_Op operation) {
  std::uint64_t result = 0;
  MPI_Allreduce(&value, &result, 1, MPI_UINT64_T, operation, MPI_COMM_WORLD);
  return result;
}

/// A soup of short fibres, dealt out fibre by fibre as they come; the first may be thick.
struct Soup {
  explicit Soup(double first_radius) {
    AssemblyBuilder builder;
    std::vector<double> radii(2000, 1e-5);
    radii[0] = first_radius;
    Random random;
    for (std::size_t fiber = 0; fiber < radii.size(); ++fiber) {
      builder.add_fiber(random_walk(random, 5, 0.01));
    }
    fibers = builder.build(radii);
    const Dealt mine = dealt_to(own_rank(), fibers, deal(fibers, 1, random));
    engine.update(mine.parts, mine.names);
  }

  FiberAssembly fibers;
  DistributedEngine engine{MPI_COMM_WORLD, one_thread()};
};

TEST(DistributedHalo, SharesAreAboutEqual) {
  Soup soup(1e-5);
  const std::uint64_t own = soup.engine.facts().own_segments;
  EXPECT_EQ(over_ranks(own, MPI_SUM), soup.fibers.segment_count());
  const double share =
      static_cast<double>(soup.fibers.segment_count()) / static_cast<double>(rank_count());
  EXPECT_LE(static_cast<double>(over_ranks(own, MPI_MAX)), 1.1 * share + 16.0);
}

TEST(DistributedHalo, OnlyWhatIsNearComes) {
  Soup soup(1e-5);
  const DistributedResult found = answer(soup.engine, within(1e-3));
  EXPECT_TRUE(same_as_one_process(found, answer("run_tree", soup.fibers, within(1e-3)).contacts));
  const std::uint64_t halo = over_ranks(soup.engine.facts().halo_segments, MPI_SUM);
  EXPECT_EQ(halo == 0, rank_count() == 1);
  EXPECT_LE(halo, soup.fibers.segment_count() / 5);
}

TEST(DistributedHalo, AThickFibreBringsNoMoreThanWhatIsNearIt) {
  Soup thin(1e-5);
  Soup thick(0.1);  // ten thousand times as thick as the others
  const DistributedResult found = answer(thick.engine, within(1e-3));
  answer(thin.engine, within(1e-3));
  const QueryResult expected = answer("run_tree", thick.fibers, within(1e-3));
  EXPECT_TRUE(same_as_one_process(found, expected.contacts));
  const std::uint64_t more = over_ranks(thick.engine.facts().halo_segments, MPI_SUM);
  const std::uint64_t few = over_ranks(thin.engine.facts().halo_segments, MPI_SUM);
  // Each contact of the thick one brings one segment at most; boxes are somewhat larger.
  EXPECT_LE(more, few + expected.contacts.size() * 2);
}

}  // namespace
}  // namespace fiber::test
