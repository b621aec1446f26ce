#include <gtest/gtest.h>

#include <stdexcept>

#include "fiber_proximity/geometry/segment_distance.hpp"

namespace fiber::test {
namespace {

TEST(Kernel, HasAName) {
  EXPECT_EQ(kernel_from_name("robust"), Kernel::ROBUST);
  EXPECT_EQ(kernel_from_name("exact"), Kernel::EXACT);
  EXPECT_EQ(kernel_names().size(), 2U);
}

TEST(Kernel, AnotherNameIsRefusedWithAllThereAre) {
  for (const char* name : {"", "Exact", "ROBUST", "exact ", "float"}) {
    try {
      kernel_from_name(name);
      ADD_FAILURE() << name;
    } catch (const std::invalid_argument& error) {
      EXPECT_EQ(error.what(),
                "unknown kernel '" + std::string(name) + "', known are: robust, exact");
    }
  }
}

}  // namespace
}  // namespace fiber::test
