// Any number of ranks finds what one process finds, to the bit, whatever parts of the fibres they
// bring.
#include "fiber_proximity/mpi/distributed_engine.hpp"

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

/// Hundreds of segments in a ball that each of them fills.
FiberAssembly dense_ball(Random& random) {
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 12; ++fiber) {
    std::vector<Vector3d> points;
    for (int i = 0; i <= 20; ++i) {
      points.emplace_back(0.05 * random.in_cube());
    }
    builder.add_fiber(points);
  }
  return builder.build({0.02});
}

/// A soup with radii of 10⁻⁵ to 10⁻¹ of the cube it is in.
FiberAssembly radii_of_all_sizes(Random& random) {
  AssemblyBuilder builder;
  std::vector<double> radii;
  for (int fiber = 0; fiber < 150; ++fiber) {
    builder.add_fiber(random_walk(random, 6, 0.05));
    radii.push_back(std::pow(10.0, random.chance(0.9) ? random.uniform(-5.0, -3.0) : -1.0));
  }
  return builder.build(radii);
}

FiberAssembly many_walks(Random& random) { return walks(random, 200, 20, 0.05, 0.005); }

std::vector<AssemblyFamily> families() {
  std::vector<AssemblyFamily> all = rank_families();
  all.push_back({"dense_ball", dense_ball});
  all.push_back(
      {"long_fiber", [](Random& random) { return ball_of_wool(random, 3000, 20.0, 0.0005); }});
  all.push_back({"radii_of_all_sizes", radii_of_all_sizes});
  all.push_back({"many_walks", many_walks});
  return all;
}

/// From 0 to where all is near; exactly the gap of a pair, and just too little for it.
double draw_margin(const FiberAssembly& fibers, Random& random) {
  const double some = extent_of(fibers) * std::pow(10.0, random.uniform(-4.0, -1.0));
  const int kind = random.integer(0, 3);
  if (kind <= 1) {
    return kind == 0 ? 0.0 : some;
  }
  const std::vector<Contact> near = answer("run_tree", fibers, within(some)).contacts;
  if (near.empty()) {
    return some;
  }
  const int any = random.integer(0, static_cast<int>(near.size()) - 1);
  const double gap = std::max(0.0, near[static_cast<std::size_t>(any)].distance);
  return kind == 2 ? gap : std::nextafter(gap, 0.0);
}

/// [m] Of a stretch of a fibre, as a sum along it.
double draw_length(const FiberAssembly& fibers, Random& random) {
  if (fibers.fiber_count() == 0) {
    return 0.0;
  }
  const auto fiber =
      static_cast<std::size_t>(random.integer(0, static_cast<int>(fibers.fiber_count()) - 1));
  double length = 0.0;
  double start = 0.0;
  const double begins = random.uniform(0.0, 0.5);
  const double ends = begins + random.uniform(0.0, 0.5);
  const std::uint32_t first = fibers.offsets()[fiber];
  const std::uint32_t count = fibers.offsets()[fiber + 1] - first;
  for (std::uint32_t i = 1; i < count * ends; ++i) {
    start = i < count * begins ? length : start;
    length += (fibers.points()[first + i] - fibers.points()[first + i - 1]).norm();
  }
  return length - start;
}

QueryOptions draw_options(const FiberAssembly& fibers, Random& random) {
  QueryOptions options = within(draw_margin(fibers, random));
  set_neighbour_skips(options, random, 4, random.chance(0.5) ? draw_length(fibers, random) : 0.0);
  if (random.chance(0.1)) {
    options.neighbour_skip.reset();
  }
  options.pairing = static_cast<Pairing>(std::max(0, random.integer(-2, 2)));
  options.kernel = random.chance(0.2) ? Kernel::EXACT : Kernel::ROBUST;
  constexpr QueryType types[] = {QueryType::ALL, QueryType::ALL, QueryType::FIBER_PAIRS,
                                 QueryType::CLOSEST, QueryType::LIMITED};
  options.type = types[random.integer(0, 4)];
  options.max_contacts = static_cast<std::uint32_t>(random.integer(1, 40));
  options.contact_limit =
      random.chance(0.3) ? static_cast<std::uint32_t>(random.integer(1, 30)) : 0;
  const bool is_bounded = options.type != QueryType::ALL;  // so that not all pairs are reported
  if (is_bounded && random.chance(0.3)) {
    options.margin = std::numeric_limits<double>::infinity();
  }
  return options;
}

/// Whether the flags and bounds of an answer hold for what one process finds.
testing::AssertionResult describes(const DistributedResult& found, const QueryResult& expected) {
  if (!found.complete) {
    return testing::AssertionFailure() << "not complete";
  }
  if (found.limit_reached != expected.limit_reached) {
    return testing::AssertionFailure() << "limit_reached is " << found.limit_reached;
  }
  return testing::AssertionSuccess();
}

class DistributedEngineTest : public testing::TestWithParam<std::size_t> {};

TEST_P(DistributedEngineTest, FindsWhatOneProcessFinds) {
  SCOPED_TRACE(seed_message());
  const AssemblyFamily family = families()[GetParam()];
  Random random(stream_of_family(GetParam()));
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  for (int scene = 0; scene < scenes_of_a_family(); ++scene) {
    FiberAssembly fibers = family.make(random);
    DistributedFibers mine = scattered_to(own_rank(), fibers, scatter(fibers, 3, random));
    const int adopted = random.integer(0, 4);
    for (int frame = 0; frame < 3; ++frame) {
      follow(fibers, mine);
      engine.update(mine.parts, mine.names);
      if (frame == adopted) {
        mine = engine.adopt();
      }
      for (int query = 0; query < 3; ++query) {
        const QueryOptions options = draw_options(fibers, random);
        const DistributedResult found = answer(engine, options);
        const QueryResult expected = answer("run_tree", fibers, options);
        const std::string trace =
            family.name + ", scene " + std::to_string(scene) + ", frame " + std::to_string(frame) +
            ", type " + std::to_string(static_cast<int>(options.type)) + ", margin " +
            text_of(options.margin) + " m, " + skips_of(options) + ", pairing " +
            std::to_string(static_cast<int>(options.pairing)) + ", at most " +
            std::to_string(options.max_contacts) + " and " + std::to_string(options.contact_limit);
        ASSERT_TRUE(same_as_one_process(found, expected.contacts)) << trace;
        ASSERT_TRUE(describes(found, expected)) << trace;
      }
      fibers = shaken(fibers, 0.02 * extent_of(fibers), random);
    }
  }
}

std::string name_of_family(const testing::TestParamInfo<std::size_t>& info) {
  return test_name(families()[info.param].name);
}

INSTANTIATE_TEST_SUITE_P(Families, DistributedEngineTest,
                         testing::Range(std::size_t{0}, families().size()), name_of_family);

TEST(DistributedEngine, WhatIsAdoptedIsNotSent) {
  Random random;
  FiberAssembly fibers = many_walks(random);
  const DistributedFibers scattered = scattered_to(own_rank(), fibers, scatter(fibers, 2, random));
  DistributedEngine engine(MPI_COMM_WORLD, one_thread());
  EXPECT_THROW(engine.adopt(), std::logic_error);
  engine.update(scattered.parts, scattered.names);
  EXPECT_EQ(over_ranks(engine.facts().sent_points, MPI_SUM) == 0, rank_count() == 1);
  DistributedFibers mine = engine.adopt();
  EXPECT_EQ(mine.parts.segment_count(), engine.facts().own_segments);
  const std::vector<Vector3d> points = mine.parts.points();
  follow(fibers, mine);
  EXPECT_EQ(mine.parts.points(), points) << "they are where the last update had them";
  for (int frame = 0; frame < 3; ++frame) {
    fibers = shaken(fibers, 0.01, random);
    follow(fibers, mine);
    engine.update(mine.parts, mine.names);
    EXPECT_EQ(engine.facts().sent_points, 0U);
    EXPECT_EQ(engine.facts().split_count, 1U);
    EXPECT_TRUE(same_as_one_process(answer(engine, within(0.01)),
                                    answer("run_tree", fibers, within(0.01)).contacts));
  }
  engine.update_motion(mine.parts, mine.parts, mine.names);
  EXPECT_THROW(engine.adopt(), std::logic_error);
}

TEST(DistributedEngine, FirstIsAnyPairThereIs) {
  Random random;
  int found_count = 0;
  for (int scene = 0; scene < rounds(60); ++scene) {
    const FiberAssembly fibers = walks(random, random.integer(2, 60), 12, 0.1, 0.002);
    ScatteredEngine engine(fibers, random);
    QueryOptions options = within(draw_margin(fibers, random));
    set_neighbour_skips(options, random, 2, 0.0);
    const std::vector<Contact> all = answer("run_tree", fibers, options).contacts;
    options.type = QueryType::FIRST;
    const DistributedResult found = answer(engine, options);
    const auto is_found = [&](const Contact& contact) {
      return same_bits(found.contacts.front(), contact);
    };
    if (own_rank() == 0) {
      ASSERT_EQ(found.contacts.size(), all.empty() ? 0U : 1U);
      ASSERT_TRUE(all.empty() || std::any_of(all.begin(), all.end(), is_found));
      found_count += all.empty() ? 0 : 1;
    }
  }
  expect_enough(own_rank() == 0 ? found_count : rounds(60), 20 / rounds_less);
}

TEST(DistributedEngine, TheClosestNeedNoMoreThanWhatIsNear) {
  Random random;
  const FiberAssembly fibers = walks(random, 500, 12, 0.01, 1e-5);
  ScatteredEngine engine(fibers, random);
  QueryOptions options = within(std::numeric_limits<double>::infinity(), QueryType::LIMITED);
  options.max_contacts = 10;
  const DistributedResult found = answer(engine, options);
  EXPECT_TRUE(same_as_one_process(found, answer("run_tree", fibers, options).contacts));
  EXPECT_LE(engine.facts().halo_segments, fibers.segment_count() / 10);
}

TEST(DistributedEngine, ALimitOfPairsAndADeadlineLeaveTheRestOut) {
  Random random;
  const FiberAssembly fibers = walks(random, 200, 20, 0.05, 0.005);
  ScatteredEngine engine(fibers, random);
  const QueryOptions options = within(0.01);
  expect_limits_leave_out(engine, options, answer("run_tree", fibers, options).contacts.size());
}

TEST(DistributedEngine, AMarginWithoutLimitBringsAllPairs) {
  Random random;
  const FiberAssembly fibers = walks(random, 10, 12, 0.1, 0.01);
  ScatteredEngine engine(fibers, random);
  const QueryOptions options = within(std::numeric_limits<double>::infinity());
  const DistributedResult found = answer(engine, options);
  EXPECT_TRUE(same_as_one_process(found, answer("run_tree", fibers, options).contacts));
}

TEST(DistributedEngine, BoundsWhatIsNotReported) {
  Random random;
  const FiberAssembly fibers = walks(random, 60, 12, 0.1, 0.01);
  ScatteredEngine engine(fibers, random);
  const QueryOptions options = within(0.01);
  const DistributedResult found = answer(engine, options);
  EXPECT_LE(found.others_lower, options.margin);
  QueryOptions more = options;
  more.margin = 0.02;
  for (const Contact& contact : answer("run_tree", fibers, more).contacts) {
    EXPECT_TRUE(contact.distance <= options.margin || contact.upper >= found.others_lower);
  }
}

}  // namespace
}  // namespace fiber::test
