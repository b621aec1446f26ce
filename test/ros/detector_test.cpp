#include "fiber_proximity/ros/detector.hpp"

#include <gtest/gtest.h>

#include <stdexcept>

namespace fiber_proximity_ros {
namespace {

const fiber::FiberAssembly unequal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}, {2, 1, 0}},
                                   {0, 2, 5}, {0.1});
const fiber::FiberAssembly equal({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {1, 1, 0}}, {0, 2, 4}, {0.1});

TEST(Detector, RefusesFibersTheEngineCannotTakeAsOftenAsItIsAsked) {
  Detector detector("AL-threaded");
  detector.set_fibers(unequal);
  EXPECT_THROW(detector.detect(fiber::QueryOptions()), std::invalid_argument);
  EXPECT_THROW(detector.engine(), std::invalid_argument);
  detector.set_fibers(equal);
  detector.detect(fiber::QueryOptions());
  ASSERT_NE(detector.minimum(), nullptr);
  EXPECT_DOUBLE_EQ(detector.minimum()->distance, 0.8);
}

TEST(Detector, FindsTheMinimumBeyondTheMarginAndWhateverTheType) {
  Detector detector("AL");
  detector.set_fibers(equal);
  fiber::QueryOptions options;
  for (const auto type : {fiber::QueryType::ALL, fiber::QueryType::FIRST}) {
    options.type = type;
    detector.detect(options);
    EXPECT_TRUE(detector.contacts().contacts.empty());
    ASSERT_NE(detector.minimum(), nullptr);
    EXPECT_DOUBLE_EQ(detector.minimum()->distance, 0.8);
  }
}

TEST(Detector, HasNoMinimumWithoutAPair) {
  const fiber::FiberAssembly none;
  Detector detector("AL");
  detector.set_fibers(none);
  detector.detect(fiber::QueryOptions());
  EXPECT_EQ(detector.minimum(), nullptr);
}

}  // namespace
}  // namespace fiber_proximity_ros
