#include "fiber_proximity/hierarchy/fiber_order.hpp"

#include <gtest/gtest.h>

namespace fiber {
namespace {

TEST(EndPointConnectedOrder, RunsForthAndBack) {
  const std::vector<std::uint32_t> expected{0, 1, 5, 4, 3, 7};
  EXPECT_EQ(end_point_connected_order({0, 3, 7, 9}), expected);
}

TEST(EndPointConnectedOrder, OfNoFibersIsEmpty) {
  EXPECT_TRUE(end_point_connected_order({0}).empty());
}

}  // namespace
}  // namespace fiber
