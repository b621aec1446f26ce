#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "fiber_proximity/query/engine.hpp"
#include "support/assemblies.hpp"

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
void operator delete(void* memory) noexcept { std::free(memory); }
void operator delete(void* memory, std::size_t /*size*/) noexcept { std::free(memory); }

namespace fiber::test {
namespace {

class AllocationTest : public testing::TestWithParam<std::string> {};

TEST_P(AllocationTest, AnUpdateWithTheSameTopologyAllocatesNothing) {
  SCOPED_TRACE(seed_message());
  Random random;
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 20; ++fiber) {
    builder.add_fiber(random_walk(random, 50, 0.1));
  }
  FiberAssembly fibers = builder.build({0.01});
  std::vector<Eigen::Vector3d> points = fibers.points();
  const auto engine = make_engine(GetParam());
  engine->update(fibers);
  for (Eigen::Vector3d& point : points) {
    point += 0.01 * random.in_cube();
  }
  const std::size_t before = allocations;
  fibers.update_points(points);
  engine->update(fibers);
  EXPECT_EQ(allocations, before);
}

// The layered hierarchies promise it; the others fit runs or divide anew.
INSTANTIATE_TEST_SUITE_P(Engines, AllocationTest,
                         testing::Values("AL", "AL-threaded", "DL-20", "SL", "OL", "brute_force"),
                         [](const auto& instance) { return test_name(instance.param); });

}  // namespace
}  // namespace fiber::test
