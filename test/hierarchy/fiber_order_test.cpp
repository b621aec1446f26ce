#include "src/hierarchy/fiber_order.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

#include "test/support/error_of.hpp"

namespace fiber {
namespace {

TEST(EndPointConnectedOrder, RunsForthAndBack) {
  const std::vector<std::uint32_t> expected{0, 1, 5, 4, 3, 7};
  EXPECT_EQ(end_point_connected_order({0, 3, 7, 9}), expected);
}

TEST(EndPointConnectedOrder, OfNoFibersIsEmpty) {
  EXPECT_TRUE(end_point_connected_order({0}).empty());
}

TEST(ThreadingOrder, PutsEqualOrdinalsSideBySide) {
  const std::vector<std::uint32_t> expected{0, 3, 6, 1, 4, 7};
  EXPECT_EQ(threading_order({0, 3, 6, 9}), expected);
  EXPECT_TRUE(threading_order({0}).empty());
}

TEST(ThreadingOrder, RefusesFibersOfDifferentLength) {
  EXPECT_EQ(test::error_of([] {
              threading_order({0, 3, 6, 8});
            }),
            "fibre 2 has 1 segment(s), fibre 0 has 2; threading needs the same number in all "
            "fibres");
}

}  // namespace
}  // namespace fiber
