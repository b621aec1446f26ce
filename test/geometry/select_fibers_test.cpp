#include <gtest/gtest.h>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {
namespace {

using Indices = std::vector<std::uint32_t>;
using Radii = std::vector<double>;

FiberAssembly selected(const Radii& radii, const Indices& selection) {
  return select_fibers({{{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}, {4, 0, 0}}, {0, 2, 5}, radii},
                       selection);
}

TEST(SelectFibers, TakesPointsInTheOrderAsked) {
  const FiberAssembly swapped = selected({0.5}, {1, 0});
  EXPECT_EQ(swapped.offsets(), (Indices{0, 3, 5}));
  EXPECT_EQ(swapped.points()[0].x(), 2.0);
  EXPECT_EQ(swapped.points()[3].x(), 0.0);
  const FiberAssembly second = selected({0.5}, {1});
  EXPECT_EQ(second.offsets(), (Indices{0, 3}));
  EXPECT_EQ(second.points()[2].x(), 4.0);
  EXPECT_EQ(selected({0.5}, {0, 0, 0}).fiber_count(), 3U);
  EXPECT_EQ(selected({0.5, 1}, {}).fiber_count(), 0U);
}

TEST(SelectFibers, TakesRadiiAlong) {
  EXPECT_EQ(selected({0.5}, {1, 0}).radii(), Radii{0.5});
  EXPECT_EQ(selected({0.5, 1}, {1, 0}).radii(), (Radii{1, 0.5}));
  EXPECT_EQ(selected({0.5, 1}, {1}).radii(), Radii{1});
  EXPECT_EQ(selected({1, 2, 3, 4, 5}, {1, 0}).radii(), (Radii{3, 4, 5, 1, 2}));
  EXPECT_EQ(selected({1, 2, 3, 4, 5}, {0}).radii(), (Radii{1, 2}));
}

}  // namespace
}  // namespace fiber
