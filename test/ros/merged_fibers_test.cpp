// Fibres of several inputs as one assembly.
#include "src/ros/inputs/merged_fibers.hpp"

#include <gtest/gtest.h>

namespace fiber_proximity_ros {
namespace {

using Radii = std::vector<double>;

/// A message of two fibres of three and two points.
FiberMessagePtr two_fibers(double height, const Radii& radii, double stamp) {
  auto message = std::make_shared<FiberMessage>();
  message->fibers = {
      {{0, 0, height}, {1, 0, height}, {2, 0, height}, {0, 1, height}, {1, 1, height}},
      {0, 3, 5},
      radii};
  const std::string name = std::to_string(static_cast<int>(height));
  message->names = {name + "/0", name + "/1"};
  message->stamp = ros::Time(stamp);
  return message;
}

Radii merged_radii(const Radii& first, const Radii& second) {
  MergedFibers merged;
  merged.merge({two_fibers(1, first, 10.0), two_fibers(2, second, 11.0)});
  return merged.message()->fibers.radii();
}

TEST(MergedFibers, AreNoneAtFirstAndOfNoMessages) {
  MergedFibers merged;
  EXPECT_EQ(merged.message()->fibers.fiber_count(), 0U);
  merged.merge({two_fibers(1, {0.5}, 10.0)});
  merged.merge({});
  EXPECT_EQ(merged.message()->fibers.fiber_count(), 0U);
  EXPECT_TRUE(merged.message()->names.empty());
}

TEST(MergedFibers, OfOneMessageAreThatMessage) {
  MergedFibers merged;
  const FiberMessagePtr message = two_fibers(1, {0.5}, 10.0);
  merged.merge({message});
  EXPECT_EQ(merged.message(), message);
}

TEST(MergedFibers, AreInTheOrderOfTheMessagesWithTheNewestStamp) {
  MergedFibers merged;
  merged.merge({two_fibers(1, {0.5}, 12.0), two_fibers(2, {0.5}, 11.0)});
  const FiberMessage& message = *merged.message();
  EXPECT_EQ(message.fibers.offsets(), (std::vector<std::uint32_t>{0, 3, 5, 8, 10}));
  EXPECT_EQ(message.names, (std::vector<std::string>{"1/0", "1/1", "2/0", "2/1"}));
  EXPECT_EQ(message.stamp, ros::Time(12.0));
  EXPECT_EQ(message.fibers.points()[4], Eigen::Vector3d(1, 1, 1));
  EXPECT_EQ(message.fibers.points()[5], Eigen::Vector3d(0, 0, 2));
}

TEST(MergedFibers, HaveRadiiInTheShortestFormThatHoldsAll) {
  EXPECT_EQ(merged_radii({0.5}, {0.5}), Radii{0.5});
  EXPECT_EQ(merged_radii({0.5}, {0.25}), (Radii{0.5, 0.5, 0.25, 0.25}));
  EXPECT_EQ(merged_radii({0.5, 0.25}, {0.125}), (Radii{0.5, 0.25, 0.125, 0.125}));
  EXPECT_EQ(merged_radii({1, 2}, {3, 4, 5, 6, 7}), (Radii{1, 1, 1, 2, 2, 3, 4, 5, 6, 7}));
}

TEST(MergedFibers, LeaveWhatSomebodyHolds) {
  MergedFibers merged;
  merged.merge({two_fibers(1, {0.5}, 10.0), two_fibers(2, {0.5}, 10.0)});
  const std::shared_ptr<const FiberMessage> held = merged.message();
  merged.merge({two_fibers(3, {0.5}, 11.0), two_fibers(4, {0.5}, 11.0)});
  EXPECT_EQ(held->fibers.points()[0].z(), 1.0);
  EXPECT_EQ(merged.message()->fibers.points()[0].z(), 3.0);
}

}  // namespace
}  // namespace fiber_proximity_ros
