#include <gtest/gtest.h>

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <new>

#include "fiber_proximity/paper/paper_engines.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/query/run_tree_engine.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/contacts.hpp"
#include "test/support/seeded_test.hpp"

namespace {
std::atomic<std::size_t> allocations{0};
}

// Counts every allocation of this process. GCC inlines one half of the pair and then believes that
// new and free are mixed.
#pragma GCC diagnostic ignored "-Wmismatched-new-delete"
void* operator new(std::size_t size) {
  ++allocations;
  if (void* memory = std::malloc(size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  ++allocations;
  if (void* memory = std::aligned_alloc(static_cast<std::size_t>(alignment), size)) {
    return memory;
  }
  throw std::bad_alloc();
}
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::align_val_t /*alignment*/) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/, std::align_val_t /*alignment*/) noexcept {
  std::free(memory);
}

namespace fiber::test {
namespace {

// Which thread does which job changes from frame to frame: all of them get to know all frames.
constexpr int warm_up = 20;

/// Calls frame(number) twice as often as it takes to reach a steady state.
/// @return how often it has allocated since
template <class Frame>
std::size_t allocations_in_steady_state(const Frame& frame) {
  std::size_t before = 0;
  for (int number = 0; number < 2 * warm_up; ++number) {
    if (number == warm_up) {
      before = allocations;
    }
    frame(number);
  }
  return allocations - before;
}

/// The same of frames of run_tree in which points stay where they are.
/// @param result that of the last frame
std::size_t allocations_at_rest(FiberAssembly fibers, std::uint32_t threads,
                                const QueryOptions& options, QueryResult& result) {
  const std::vector<Eigen::Vector3d> points = fibers.points();
  const auto engine = make_engine("run_tree", {threads});
  return allocations_in_steady_state([&](int /*frame*/) {
    fibers.update_points(points);
    engine->update(fibers);
    engine->query(options, result);
  });
}

class AllocationTest : public testing::TestWithParam<std::string> {
 protected:
  static void SetUpTestSuite() { register_paper_engines(); }
};

TEST_P(AllocationTest, AnUpdateWithTheSameTopologyAllocatesNothing) {
  SCOPED_TRACE(seed_message());
  Random random;
  FiberAssembly fibers = walks(random, 20, 50, 0.1, 0.01);
  const std::vector<Eigen::Vector3d> points = shaken(fibers, 0.01, random).points();
  const auto engine = make_engine(GetParam());
  engine->update(fibers);
  const std::size_t before = allocations;
  fibers.update_points(points);
  engine->update(fibers);
  EXPECT_EQ(allocations, before);
}

TEST(RunTreeAllocationTest, AFrameInSteadyStateAllocatesNothing) {
  SCOPED_TRACE(seed_message());
  Random random;
  // Enough for several threads to have a part.
  const FiberAssembly fibers = walks(random, 400, 50, 0.1, 0.02);
  QueryResult result;
  const std::size_t found = allocations_at_rest(fibers, 2, {}, result);
  expect_enough(result.contacts.size(), std::size_t{1});
  EXPECT_EQ(found, 0U);
}

TEST(RunTreeAllocationTest, AMotionInSteadyStateAllocatesNothing) {
  SCOPED_TRACE(seed_message());
  Random random;
  const FiberAssembly before = walks(random, 400, 50, 0.1, 0.02);
  FiberAssembly after = before;
  const std::vector<Eigen::Vector3d> points = shaken(before, 0.05, random).points();
  const auto engine = make_engine("run_tree", {2});
  MotionResult result;
  const std::size_t found = allocations_in_steady_state([&](int /*frame*/) {
    after.update_points(points);
    engine->update_motion(before, after);
    engine->query_motion({}, result);
  });
  expect_enough(result.contacts.size(), std::size_t{1});
  expect_enough(result.touching.size(), std::size_t{1});
  EXPECT_EQ(found, 0U);
}

class TouchingItselfAllocationTest : public testing::TestWithParam<int> {};

/// Found by the campaign: a contact of a fibre with itself over more than a few segments.
TEST_P(TouchingItselfAllocationTest, AFrameInWhichAFiberTouchesItselfAllocatesNothing) {
  const int segments = GetParam();
  std::vector<Eigen::Vector3d> hairpin;
  for (int i = 0; i <= segments; ++i) {
    hairpin.emplace_back(0.1 * std::min(i, segments - i), 0.05 * i / segments, 0.0);
  }
  QueryResult result;
  const std::size_t found = allocations_at_rest(as_fibers({hairpin}, 0.03), 1, {}, result);
  ASSERT_FALSE(result.contacts.empty());
  EXPECT_EQ(result.contacts.front().segment_a, 0U);
  EXPECT_GT(static_cast<int>(result.contacts.front().segment_b), segments - 10);
  EXPECT_EQ(found, 0U);
}

// Points between are looked at one by one, by what is known of their fibre, and by boxes of many.
INSTANTIATE_TEST_SUITE_P(Segments, TouchingItselfAllocationTest, testing::Values(50, 100, 1000),
                         testing::PrintToStringParamName());

TEST(RunTreeAllocationTest, AFrameInWhichSomeFibersMoveAllocatesNothing) {
  SCOPED_TRACE(seed_message());
  Random random;
  FiberAssembly fibers = walks(random, 100, 50, 0.1, 0.02);
  std::vector<Eigen::Vector3d> points = fibers.points();
  RunTreeEngine engine({1, 0.01});
  QueryResult result;
  const std::size_t found = allocations_in_steady_state([&](int frame) {
    for (int i = 0; i < 50; ++i) {  // the first fibre goes there and back
      points[i].x() += frame % 2 == 0 ? 0.05 : -0.05;
    }
    fibers.update_points(points);
    engine.update(fibers);
    engine.query({}, result);
  });
  EXPECT_EQ(engine.partial_count(), 2U * warm_up - 1);
  expect_enough(result.contacts.size(), std::size_t{1});
  EXPECT_EQ(found, 0U);
}

class FiberPairsAllocationTest : public SeededTest {};

TEST_P(FiberPairsAllocationTest, AskingAgainAllocatesNothing) {
  SCOPED_TRACE(seed_message());
  Random random(seed(), 0);
  const FiberAssembly fibers = walks(random, 100, 10, 0.1, 0.02);
  const auto engine = make_engine("run_tree");
  engine->update(fibers);
  const QueryOptions options = within(0.5, QueryType::FIBER_PAIRS);
  QueryResult result;
  engine->query(options, result);
  expect_enough(result.contacts.size(), std::size_t{101});  // or the table has not grown
  const std::size_t before = allocations;
  engine->query(options, result);
  EXPECT_EQ(allocations, before);
}

INSTANTIATE_TEST_SUITE_P(Seeds, FiberPairsAllocationTest, run_seed_and({78366793}), name_of_seed);

/// All segments of a fibre are then looked at together: whether it makes a loop at all.
TEST(RunTreeAllocationTest, AFrameWhoseMarginIsLargerThanItsFibersAllocatesNothing) {
  SCOPED_TRACE(seed_message());
  Random random;
  QueryResult result;
  const std::size_t found = allocations_at_rest(walks(random, 100, 10, 0.1, 0.02), 2,
                                                within(10.0, QueryType::FIBER_PAIRS), result);
  EXPECT_GE(result.contacts.size(), 100U * 99U / 2U);
  EXPECT_EQ(found, 0U);
}

// The layered hierarchies promise it; the others fit runs or divide anew.
INSTANTIATE_TEST_SUITE_P(Engines, AllocationTest,
                         testing::Values("run_tree", "AL", "AL-threaded", "DL-20", "SL", "OL",
                                         "brute_force"),
                         [](const auto& instance) { return test_name(instance.param); });

}  // namespace
}  // namespace fiber::test
