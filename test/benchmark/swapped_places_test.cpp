#include "benchmark/swapped_places.hpp"

#include <gtest/gtest.h>

namespace fiber::test {
namespace {

TEST(SwappedPlaces, PutsEachFiberWhereAnotherOneBegan) {
  const FiberAssembly fibers({{0, 0, 0}, {1, 0, 0}, {5, 0, 0}, {5, 1, 0}, {9, 0, 0}, {9, 0, 2}},
                             {0, 2, 4, 6}, {0.1});
  const std::vector<Eigen::Vector3d> expected{{9, 0, 0}, {10, 0, 0}, {5, 0, 0},
                                              {5, 1, 0}, {0, 0, 0},  {0, 0, 2}};
  EXPECT_EQ(swapped_places(fibers), expected);
}

TEST(SwappedPlaces, TakesNoFibers) { EXPECT_TRUE(swapped_places(FiberAssembly()).empty()); }

}  // namespace
}  // namespace fiber::test
