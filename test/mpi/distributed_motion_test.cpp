// Any number of ranks finds of a motion what one process finds, to the bit.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "test/mpi/gathered_motions.hpp"
#include "test/mpi/scattered_fibers.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

MotionOptions draw_options(double extent, Random& random) {
  QueryOptions pairs =
      within(random.chance(0.3) ? 0.0 : extent * std::pow(10.0, random.uniform(-4.0, -2.0)));
  set_neighbour_skips(pairs, random, 4, extent * random.uniform(0.0, 0.3));
  pairs.pairing = static_cast<Pairing>(std::max(0, random.integer(-2, 2)));
  pairs.contact_limit = random.chance(0.3) ? static_cast<std::uint32_t>(random.integer(1, 30)) : 0;
  pairs.max_contacts = static_cast<std::uint32_t>(random.integer(1, 40));
  constexpr QueryType types[] = {QueryType::ALL, QueryType::FIRST, QueryType::LIMITED};
  pairs.type = types[random.integer(0, 2)];
  MotionOptions options =
      motion_options(pairs, extent * std::pow(10.0, random.uniform(-9.0, -4.0)));
  if (random.chance(0.3)) {
    options.time_tolerance = random.uniform(1e-6, 1e-2);
  }
  return options;
}

/// Updates the ranks' engine.
void update(DistributedEngine& engine, const FiberAssembly& before, const FiberAssembly& after,
            const std::vector<ScatteredPart>& scattered) {
  const DistributedFibers from = scattered_to(own_rank(), before, scattered);
  const DistributedFibers to = scattered_to(own_rank(), after, scattered);
  engine.update_motion(from.parts, to.parts, from.names);
}

class DistributedMotionTest : public testing::TestWithParam<std::size_t> {};

void expect_what_one_process_finds(const AssemblyFamily& family, std::uint64_t stream, int scenes) {
  SCOPED_TRACE(seed_message());
  Random random(stream);
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  for (int scene = 0; scene < scenes; ++scene) {
    FiberAssembly before = family.make(random);
    const double extent = extent_of(before);
    const std::vector<ScatteredPart> scattered = scatter(before, 3, random);
    for (int frame = 0; frame < 2; ++frame) {
      const FiberAssembly after = shaken(before, 0.02 * extent, random);
      update(engine, before, after, scattered);
      const auto one = make_engine("run_tree", one_thread());
      one->update_motion(before, after);
      for (int query = 0; query < 3; ++query) {
        const MotionOptions options = draw_options(extent, random);
        MotionResult expected;
        one->query_motion(options, expected);
        DistributedMotionResult found;
        engine.query_motion(options, found);
        const std::string trace =
            family.name + ", scene " + std::to_string(scene) + ", frame " + std::to_string(frame) +
            ", type " + std::to_string(static_cast<int>(options.type)) + ", margin " +
            std::to_string(options.margin) + " m, at most " + std::to_string(options.contact_limit);
        ASSERT_TRUE(same_as_one_process(found.contacts, expected.contacts)) << trace;
        ASSERT_TRUE(same_as_one_process(found.touching, expected.touching))
            << trace << ", touching";
        ASSERT_EQ(found.complete, expected.complete) << trace;
        ASSERT_EQ(found.limit_reached, expected.limit_reached) << trace;
        ASSERT_EQ(found.others_lower, expected.others_lower) << trace;
      }
      before = after;
    }
  }
}

TEST_P(DistributedMotionTest, FindsWhatOneProcessFinds) {
  expect_what_one_process_finds(rank_families()[GetParam()], stream_of_family(GetParam()),
                                scenes_of_a_family());
}

/// Over four ranks, one contact too many: a loop was found in the halo of the scene before.
TEST(DistributedMotion, ForgetsWhereOthersWere) {
  const std::vector<AssemblyFamily> families = rank_families();
  const auto family = std::find_if(families.begin(), families.end(), [](const auto& other) {
    return other.name == "millimetres_at_1e8";
  });
  ASSERT_NE(family, families.end());
  expect_what_one_process_finds(*family, 35, rounds(6));
}

std::string name_of_rank_family(const testing::TestParamInfo<std::size_t>& info) {
  return test_name(rank_families()[info.param].name);
}

INSTANTIATE_TEST_SUITE_P(Families, DistributedMotionTest,
                         testing::Range(std::size_t{0}, rank_families().size()),
                         name_of_rank_family);

/// Walks that come close to each other as they are shaken.
struct Shaken {
  FiberAssembly before;
  FiberAssembly after;
  std::vector<ScatteredPart> scattered;

  explicit Shaken(Random& random)
      : before(walks(random, 100, 20, 0.05, 0.005)),
        after(shaken(before, 0.05, random)),
        scattered(scatter(before, 3, random)) {}
};

TEST(DistributedMotion, FindsContactsOfEveryKind) {
  Random random;
  const Shaken fibers(random);
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  update(engine, fibers.before, fibers.after, fibers.scattered);
  MotionOptions options;
  options.margin = 0.02;
  DistributedMotionResult found;
  engine.query_motion(options, found);
  EXPECT_GT(gathered(found.contacts).size(), 20U) << "or the tests compare nothing with nothing";
  EXPECT_GT(gathered(found.touching).size(), 20U);
}

TEST(DistributedMotion, ReportsNothingBeyondALimitOfPairs) {
  Random random;
  const Shaken fibers(random);
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  update(engine, fibers.before, fibers.after, fibers.scattered);
  MotionOptions options;
  options.pair_limit = 10;
  DistributedMotionResult found;
  engine.query_motion(options, found);
  EXPECT_TRUE(found.limit_reached);
  EXPECT_FALSE(found.complete);
  EXPECT_EQ(found.others_lower, 0.0);
  EXPECT_TRUE(gathered(found.contacts).empty() && gathered(found.touching).empty());
  options.pair_limit = 0;
  options.deadline = 1e-9;
  engine.query_motion(options, found);
  EXPECT_FALSE(found.complete);
}

TEST(DistributedMotion, IsForQueriesAboutMotionsOnly) {
  Random random;
  const Shaken fibers(random);
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  DistributedMotionResult motion;
  DistributedResult result;
  EXPECT_THROW(engine.query_motion({}, motion), std::logic_error);
  update(engine, fibers.before, fibers.after, fibers.scattered);
  EXPECT_THROW(engine.query({}, result), std::logic_error);
  const DistributedFibers mine = scattered_to(own_rank(), fibers.before, fibers.scattered);
  engine.update(mine.parts, mine.names);
  EXPECT_THROW(engine.query_motion({}, motion), std::logic_error);
  engine.query(within(0.001), result);
  EXPECT_TRUE(same_as_one_process(gather(MPI_COMM_WORLD, result),
                                  answer("run_tree", fibers.before, within(0.001)).contacts));
}

TEST(DistributedMotion, RefusesFibersThatAreOthersAfterwards) {
  Random random;
  const Shaken fibers(random);
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  const DistributedFibers from = scattered_to(own_rank(), fibers.before, fibers.scattered);
  const bool is_wrong = own_rank() == 0;
  const FiberAssembly other({{0, 0, 0}, {1, 0, 0}}, {0, 2}, {0.1});
  EXPECT_THROW(engine.update_motion(from.parts, is_wrong ? other : from.parts, from.names),
               std::invalid_argument)
      << "on every rank";
  MotionOptions options;
  options.tolerance = -1.0;
  update(engine, fibers.before, fibers.after, fibers.scattered);
  DistributedMotionResult motion;
  EXPECT_THROW(engine.query_motion(options, motion), std::invalid_argument);
  options.tolerance = 1e-6 * (1.0 + own_rank());
  if (rank_count() == 1) {
    return;  // one rank alone always agrees with itself
  }
  EXPECT_THROW(engine.query_motion(options, motion), std::invalid_argument);
}

}  // namespace
}  // namespace fiber::test
