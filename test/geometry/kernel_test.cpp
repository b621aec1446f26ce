#include <gtest/gtest.h>

#include <stdexcept>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/error_of.hpp"

namespace fiber::test {
namespace {

TEST(Kernel, HasAName) {
  EXPECT_EQ(kernel_from_name("robust"), Kernel::ROBUST);
  EXPECT_EQ(kernel_from_name("exact"), Kernel::EXACT);
  EXPECT_EQ(kernel_names().size(), 2U);
}

TEST(Kernel, AnotherNameIsRefusedWithAllThereAre) {
  for (const char* name : {"", "Exact", "ROBUST", "exact ", "float"}) {
    EXPECT_EQ(error_of([&] { kernel_from_name(name); }),
              "unknown kernel '" + std::string(name) + "', known are: robust, exact");
  }
}

}  // namespace
}  // namespace fiber::test
