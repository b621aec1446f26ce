// With a skin, run_tree keeps its tree and its candidates while fibres move little: no answer may
// show that.
#include <gtest/gtest.h>

#include <algorithm>
#include <limits>

#include "src/query/run_tree_engine.hpp"
#include "test/support/answers.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/query_options.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// As brute force has it; of FIRST, any pair that brute force knows, or none.
void expect_answer(const FiberAssembly& fibers, const QueryOptions& options,
                   const std::vector<Contact>& found) {
  QueryOptions wanted = options;
  if (options.type == QueryType::FIRST) {
    wanted.type = QueryType::ALL;
    wanted.contact_limit = 0;
  }
  const QueryResult truth = brute_force(fibers, wanted);
  if (options.type == QueryType::FIRST) {
    ASSERT_EQ(found.empty(), truth.contacts.empty());
    EXPECT_TRUE(found.empty() || contains(truth.contacts, found.front()));
    return;
  }
  EXPECT_TRUE(same_contacts(found, truth.contacts));
}

TEST(SkinTest, AnswersAsBruteForceWhileFibersMove) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::uint64_t frames = 0;
  std::uint64_t refits = 0;
  for (int round = 0; round < rounds(10); ++round) {
    for (const AssemblyFamily& family : assembly_families()) {
      SCOPED_TRACE(family.name);
      FiberAssembly fibers = family.make(random);
      const double size = extent_of(fibers);
      const double skin = size * random.uniform(0.0, 0.2);
      RunTreeEngine engine({1, skin});
      QueryOptions options = random_options(random, size);
      // Only those that ask for all keep candidates.
      options.type = random.chance(0.5) ? QueryType::ALL : options.type;
      for (int frame = 0; frame < 10; ++frame) {
        engine.update(fibers);
        expect_answer(fibers, options, answer(engine, options).contacts);
        const QueryOptions others = random.chance(0.5) ? with_one_drawn_anew(options, random, size)
                                                       : random_options(random, size);
        expect_answer(fibers, others, answer(engine, others).contacts);
        const double way = skin * random.uniform(0.0, 0.3);
        fibers.update_points(shaken(fibers, way, random).points());
        ++frames;
      }
      refits += engine.refit_count();
    }
  }
  // Both ways are taken, and often.
  expect_enough(refits, frames / 10 + 1);
  expect_enough(frames - refits, frames / 10 + 1);
}

/// Moves some of the fibres, each as a whole and as far as it likes, and all others a little.
void move_some(Random& random, FiberAssembly& fibers, double far, double little) {
  std::vector<Vector3d> points = fibers.points();
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const Vector3d step = random.in_cube(random.chance(0.05) ? far : little);
    for (std::uint32_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
      points[i] += step;
    }
  }
  fibers.update_points(points);
}

TEST(SkinTest, AnswersAsBruteForceWhileSomeFibersMove) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::uint64_t refits = 0;
  std::uint64_t partial = 0;
  std::size_t found = 0;
  for (int round = 0; round < rounds(30); ++round) {
    AssemblyBuilder builder;
    for (int fiber = 0; fiber < 30; ++fiber) {
      builder.add_fiber(random_walk(random, random.integer(2, 12), 0.1));
    }
    FiberAssembly fibers = builder.build({0.02});
    const double skin = random.uniform(0.01, 0.3);
    RunTreeEngine engine({1, skin});
    QueryOptions options = random_options(random, 1.0);
    options.type = QueryType::ALL;
    options.neighbour_skip_length = 0.0;
    QueryResult result;
    for (int frame = 0; frame < 40; ++frame) {
      engine.update(fibers);
      if (random.chance(0.7)) {  // several updates may come between two queries
        engine.query(options, result);
        expect_answer(fibers, options, result.contacts);
        found += result.contacts.size();
      }
      if (random.chance(0.2)) {  // others replace the kept candidates, or use the tree itself
        const QueryOptions others = random.chance(0.5) ? with_one_drawn_anew(options, random, 1.0)
                                                       : random_options(random, 1.0);
        engine.query(others, result);
        expect_answer(fibers, others, result.contacts);
      }
      move_some(random, fibers, 1.0, 0.05 * skin);
    }
    refits += engine.refit_count();
    partial += engine.partial_count();
  }
  expect_enough<std::size_t>(found, rounds(1001));
  expect_enough<std::uint64_t>(partial, rounds(201));
  expect_enough<std::uint64_t>(refits - partial, rounds(51));
}

/// Ten fibres far from each other, but for the first two: parallel, at these heights [m].
FiberAssembly two_of_ten(double height_a, double height_b) {
  AssemblyBuilder builder;
  builder.add_fiber({{0.0, height_a, 0.0}, {1.0, height_a, 0.0}});
  builder.add_fiber({{0.0, height_b, 0.0}, {1.0, height_b, 0.0}});
  for (int i = 1; i < 9; ++i) {
    builder.add_fiber({{1000.0 * i, 0.0, 0.0}, {1000.0 * i, 1.0, 0.0}});
  }
  return builder.build({0.0});
}

/// One fibre comes from afar when the other has already moved away by nearly a quarter of the skin;
/// then both come together as far as the skin lets them.
TEST(SkinTest, CountsWhatFibersHadMovedBeforeOthersWereLookedForAnew) {
  RunTreeEngine engine({1, 1.0});
  QueryResult result;
  for (const FiberAssembly& frame :
       {two_of_ten(0.0, 100.0), two_of_ten(-0.24, 0.98), two_of_ten(0.4900001, 0.49)}) {
    engine.update(frame);
    for (const QueryType type : {QueryType::ALL, QueryType::CLOSEST}) {
      const QueryOptions options = within(0.001, type);
      engine.query(options, result);
      expect_answer(frame, options, result.contacts);
    }
  }
  EXPECT_EQ(result.contacts.size(), 1U);
  EXPECT_EQ(engine.partial_count(), 1U);
  EXPECT_EQ(engine.refit_count(), 2U);
}

TEST(SkinTest, MeasuresFromWhereFibersWereLookedForAnew) {
  RunTreeEngine engine({1, 1.0});
  for (const double height : {100.0, 50.0, 49.9, 49.8, 20.0, 20.1}) {
    const FiberAssembly frame = two_of_ten(0.0, height);
    engine.update(frame);
  }
  EXPECT_EQ(engine.partial_count(), 2U);
  EXPECT_EQ(engine.refit_count(), 3U);
}

TEST(SkinTest, AShapeMeetsFibersThatHaveMoved) {
  SCOPED_TRACE(seed_message());
  Random random;
  std::size_t found = 0;
  for (int round = 0; round < 200; ++round) {
    FiberAssembly fibers = walks(random, 1, 40, 0.1, 0.02);
    RunTreeEngine engine({1, 0.2});
    engine.update(fibers);
    fibers.update_points(shaken(fibers, 0.05, random).points());
    engine.update(fibers);
    EXPECT_EQ(engine.refit_count(), 1U);
    const FiberAssembly shape = walks(random, 1, 5, 0.2, 0.1);
    for (const QueryType type : {QueryType::ALL, QueryType::CLOSEST}) {
      const QueryOptions options = within(0.3, type);
      const QueryResult truth = brute_force(shape, fibers, options);
      EXPECT_TRUE(same_contacts(answer(engine, shape, options).contacts, truth.contacts));
      found += truth.contacts.size();
    }
  }
  expect_enough(found, std::size_t{101});
}

/// Two fibres that are as far apart as the skin and come together by just as much.
TEST(SkinTest, LosesNothingAtItsVeryEdge) {
  const double skin = 0.25;
  FiberAssembly fibers =
      as_fibers({{{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}}, {{0.0, skin, 0.0}, {1.0, skin, 0.0}}});
  RunTreeEngine engine({1, skin});
  QueryResult result;
  engine.update(fibers);
  engine.query({}, result);
  EXPECT_TRUE(result.contacts.empty());
  // The bound is rounded up, so half of the skin itself may be too far for the old tree.
  for (const double half : {0.49 * skin, 0.5 * skin}) {
    std::vector<Vector3d> points = fibers.points();
    points[0].y() = points[1].y() = half;
    points[2].y() = points[3].y() = skin - half;
    fibers.update_points(points);
    engine.update(fibers);
    const QueryOptions options = within(skin - 2.0 * half);
    const QueryResult truth = brute_force(fibers, options);
    ASSERT_FALSE(truth.contacts.empty());
    engine.query(options, result);
    EXPECT_TRUE(same_contacts(result.contacts, truth.contacts));
  }
}

TEST(SkinTest, SeesThatRadiiOrTopologyHaveChanged) {
  AssemblyBuilder builder;
  builder.add_fiber({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}, {2.0, 0.0, 0.0}});
  builder.add_fiber({{0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}});
  AssemblyBuilder other;
  other.add_fiber({{0.0, 0.0, 0.0}, {1.0, 0.0, 0.0}});
  other.add_fiber({{1.0, 0.5, 0.0}, {0.0, 1.0, 0.0}, {1.0, 1.0, 0.0}});
  RunTreeEngine engine({1, 0.1});
  QueryResult result;
  const auto contacts = [&](const FiberAssembly& fibers) {
    engine.update(fibers);
    engine.query({}, result);
    const QueryResult truth = brute_force(fibers, {});
    EXPECT_TRUE(same_contacts(result.contacts, truth.contacts));
    return result.contacts.size();
  };
  const FiberAssembly thin = builder.build({0.1});
  const FiberAssembly thick = builder.build({0.6});
  const FiberAssembly moved = other.build({0.3});
  EXPECT_EQ(contacts(thin), 0U);
  EXPECT_EQ(contacts(thick), 2U);
  EXPECT_EQ(contacts(moved), 1U);
}

TEST(SkinTest, RefusesWhatIsNoLength) {
  for (const double skin :
       {-1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()}) {
    EXPECT_THROW(make_engine("run_tree", {1, skin}), std::invalid_argument) << skin;
  }
}

}  // namespace
}  // namespace fiber::test
