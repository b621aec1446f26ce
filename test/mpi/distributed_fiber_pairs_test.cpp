// The closest pair of each pair of fibres over ranks, with a margin and without: what one process
// finds, and for no more work.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/io/number.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double no_margin = std::numeric_limits<double>::infinity();

/// Turns of a helix that lie in each other.
FiberAssembly coil(std::uint32_t count) {
  std::vector<Vector3d> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double t = 200.0 * i / (count - 1);
    points.emplace_back(0.05 * std::cos(t), 0.05 * std::sin(t), 0.0012 * t);
  }
  return as_fibers({points}, 0.0045);
}

/// A circle that is not closed: no two of its segments make a loop.
FiberAssembly arc(std::uint32_t count) {
  std::vector<Vector3d> points;
  for (std::uint32_t i = 0; i < count; ++i) {
    const double t = 2.0 * i / (count - 1);
    points.emplace_back(std::cos(t), std::sin(t), 0.0);
  }
  return as_fibers({points}, 0.001);
}

/// What one process counts, and all ranks together.
struct Work {
  QueryCounts one;
  QueryCounts all;
  std::uint64_t halo_segments = 0;
};

Work work_of(const FiberAssembly& fibers, const QueryOptions& options) {
  Random random;
  ScatteredEngine engine(fibers, random);
  const DistributedResult found = answer(engine, options);
  const QueryResult expected = answer("run_tree", fibers, options);
  EXPECT_TRUE(same_as_one_process(found, expected.contacts));
  const DistributedFacts facts = engine.facts();
  return {expected.counts,
          {over_ranks(facts.query_counts.node_tests, MPI_SUM),
           over_ranks(facts.query_counts.node_overlaps, MPI_SUM),
           over_ranks(facts.query_counts.primitive_tests, MPI_SUM)},
          over_ranks(facts.halo_segments, MPI_SUM)};
}

TEST(DistributedFiberPairs, OfACoilCostNoMoreThanInOneProcess) {
  const std::uint32_t count = 1200;
  const Work work = work_of(coil(count), within(no_margin, QueryType::FIBER_PAIRS));
  EXPECT_LE(2 * work.all.primitive_tests, 3 * work.one.primitive_tests);
  EXPECT_LE(2 * work.all.node_tests, 3 * work.one.node_tests);
  // Two ranks have a half each, that meet at a turn; more have parts of many turns.
  EXPECT_LE(work.halo_segments, rank_count() == 2 ? count / 10 : count);
}

TEST(DistributedFiberPairs, OfAnArcThatTouchesNothingCostFew) {
  const Work work = work_of(arc(1200), within(no_margin, QueryType::FIBER_PAIRS));
  EXPECT_LE(2 * work.all.primitive_tests, 3 * work.one.primitive_tests);
}

TEST(DistributedFiberPairs, OfManyFibersCostNoMoreThanInOneProcess) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly fibers = walks(random, 30, 40, 0.1, 0.01);
  for (const Pairing pairing : {Pairing::ALL, Pairing::SAME_FIBER, Pairing::DIFFERENT_FIBERS}) {
    QueryOptions options = within(no_margin, QueryType::FIBER_PAIRS);
    options.pairing = pairing;
    const Work work = work_of(fibers, options);
    EXPECT_LE(2 * work.all.primitive_tests,
              3 * work.one.primitive_tests +
                  static_cast<std::uint64_t>(rank_count()) * fibers.segment_count())
        << "pairing " << static_cast<int>(pairing);
  }
}

/// Fibres of few segments and of many, alone and in heaps.
FiberAssembly some_fibers(Random& random) {
  switch (random.integer(0, 4)) {
    case 4:
      return ball_of_wool(random, 800, 10.0, 0.0001);
    case 0:
      return coil(static_cast<std::uint32_t>(random.integer(3, 400)));
    case 1:
      return walks(random, 1, random.integer(2, 400), 0.05, 0.01);
    case 2:
      return walks(random, random.integer(2, 6), random.integer(2, 120), 0.1, 0.005);
    default:
      return walks(random, random.integer(10, 40), random.integer(2, 20), 0.1, 0.01);
  }
}

TEST(DistributedFiberPairs, AreThoseOfOneProcess) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(80); ++round) {
    const FiberAssembly fibers = some_fibers(random);
    ScatteredEngine engine(fibers, random);
    for (int query = 0; query < 4; ++query) {
      QueryOptions options =
          within(random.chance(0.5) ? no_margin : std::pow(10.0, random.uniform(-4.0, -0.5)),
                 QueryType::FIBER_PAIRS);
      if (random.chance(0.5)) {  // otherwise loops decide
        set_neighbour_skips(options, random, 30, random.chance(0.5) ? 0.2 : 0.0);
      }
      options.pairing = static_cast<Pairing>(std::max(0, random.integer(-2, 2)));
      options.kernel = random.chance(0.2) ? Kernel::EXACT : Kernel::ROBUST;
      options.contact_limit =
          random.chance(0.2) ? static_cast<std::uint32_t>(random.integer(1, 9)) : 0;
      const QueryResult expected = answer("run_tree", fibers, options);
      const DistributedResult found = answer(engine, options);
      ASSERT_TRUE(same_as_one_process(found, expected.contacts))
          << "round " << round << ", margin " << text_of(options.margin) << " m, "
          << skips_of(options) << ", pairing " << static_cast<int>(options.pairing);
      ASSERT_EQ(found.limit_reached, expected.limit_reached);
      ASSERT_TRUE(found.complete);
    }
  }
}

TEST(DistributedFiberPairs, BoundWhatIsNotReported) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(20); ++round) {
    const FiberAssembly fibers = walks(random, random.integer(1, 6), 40, 0.1, 0.01);
    ScatteredEngine engine(fibers, random);
    const DistributedResult found = answer(engine, within(no_margin, QueryType::FIBER_PAIRS));
    const auto is_reported = [&](const Contact& contact) {
      return std::any_of(found.contacts.begin(), found.contacts.end(),
                         [&](const DistributedContact& x) { return same_bits(x, contact); });
    };
    for (const Contact& contact : answer("run_tree", fibers, within(no_margin)).contacts) {
      if (own_rank() == 0 && contact.upper < found.others_lower) {
        ASSERT_TRUE(is_reported(contact)) << "round " << round;
      }
    }
  }
}

TEST(DistributedFiberPairs, ALimitOfPairsAndADeadlineLeaveTheRestOut) {
  Random random;
  const FiberAssembly fibers = walks(random, 60, 40, 0.05, 0.005);
  ScatteredEngine engine(fibers, random);
  const QueryOptions options = within(no_margin, QueryType::FIBER_PAIRS);
  expect_limits_leave_out(engine, options, answer("run_tree", fibers, options).contacts.size());
}

}  // namespace
}  // namespace fiber::test
