// Closed and joined fibres of messages.
#include "src/ros/inputs/closed_fibers.hpp"

#include <gtest/gtest.h>

#include <limits>

#include "src/ros/inputs/merged_fibers.hpp"
#include "src/ros/inputs/missing_points.hpp"

namespace fiber_proximity_ros {
namespace {

using Closed = std::vector<std::uint8_t>;
using Joints = std::vector<std::int32_t>;
using Counts = std::vector<std::uint32_t>;

/// A ring of five points, and a branch of three that begins at its third one.
FiberBuffer ring_with_branch() {
  FiberBuffer buffer;
  buffer.points = {{0, 0, 0}, {1, 0, 0}, {2, 1, 0}, {1, 2, 0},
                   {0, 2, 0}, {2, 1, 0}, {3, 1, 0}, {4, 1, 0}};
  buffer.offsets = {0, 5, 8};
  buffer.radii = {0.1};
  buffer.names = {"ring", "branch"};
  buffer.topology.closed = {1, 0};
  buffer.topology.joints = {-1, -1, 6, -1, -1, 6, -1, -1};
  return buffer;
}

void lose(FiberBuffer& buffer, std::size_t point) {
  buffer.points[point].y() = std::numeric_limits<double>::quiet_NaN();
}

TEST(ClosedFibers, GoThroughMessagesAsTheyAre) {
  FiberBuffer buffer = ring_with_branch();
  fiber::FiberAssembly fibers;
  assign(buffer, fibers);
  EXPECT_TRUE(fibers.is_closed(0));
  EXPECT_EQ(fibers.segment_count(), 7U);
  fiber_proximity::FiberArray message;
  to_message(fibers, {"ring", "branch"}, message);
  EXPECT_EQ(message.closed, (Closed{1, 0}));
  EXPECT_EQ(message.joints, (Joints{-1, -1, 6, -1, -1, 6, -1, -1}));
  EXPECT_EQ(message.offsets, (Counts{0, 5, 8}));
  ASSERT_EQ(message.points.size(), 8U);
  EXPECT_EQ(message.points[7].x, 4.0);
  FiberBuffer again;
  to_chains(message, again);
  fiber::FiberAssembly read;
  assign(again, read);
  EXPECT_TRUE(read.has_topology_of(fibers));
  EXPECT_EQ(read.points(), fibers.points());

  // Points alone, of the same fibres.
  FiberBuffer moved = ring_with_branch();
  for (Eigen::Vector3d& point : moved.points) {
    point.z() = 1.0;
  }
  const fiber::FiberGraph* const graph = read.graph().get();
  assign(moved, read);
  EXPECT_EQ(read.graph().get(), graph) << "nothing but points is new";
  EXPECT_EQ(read.points()[5], Eigen::Vector3d(0, 0, 1)) << "the first point again";

  // Chains of as many points.
  FiberBuffer open = ring_with_branch();
  open.topology = {};
  assign(open, read);
  EXPECT_EQ(read.graph(), nullptr);
  EXPECT_EQ(read.segment_count(), 6U);
  to_message(read, {}, message);
  EXPECT_TRUE(message.closed.empty() && message.joints.empty());
}

TEST(ClosedFibers, OfAWrongNumberAreRefused) {
  for (int wrong = 0; wrong < 2; ++wrong) {
    FiberBuffer buffer = ring_with_branch();
    if (wrong == 0) {
      buffer.topology.closed.pop_back();
    } else {
      buffer.topology.joints.pop_back();
    }
    EXPECT_FALSE(has_sound_layout(buffer));
    fiber::FiberAssembly fibers;
    EXPECT_THROW(assign(buffer, fibers), std::invalid_argument);
  }
}

TEST(ClosedFibers, ThatEndWhereTheyBeginAreClosedIfAsked) {
  FiberBuffer buffer;
  buffer.points = {{0, 0, 0}, {1, 0, 0}, {0, 0, 0},             // too short
                   {0, 1, 0}, {1, 1, 0}, {1, 2, 0}, {0, 1, 0},  // a ring
                   {5, 5, 5}, {6, 5, 5}};
  buffer.offsets = {0, 3, 7, 9};
  buffer.radii = {1, 1, 1, 2, 3, 4, 2, 5, 6};
  close_rings(buffer);
  EXPECT_EQ(buffer.offsets, (Counts{0, 3, 6, 8}));
  EXPECT_EQ(buffer.topology.closed, (Closed{0, 1, 0}));
  EXPECT_EQ(buffer.radii, (std::vector<double>{1, 1, 1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(buffer.points[6], Eigen::Vector3d(5, 5, 5));

  FiberBuffer chains;
  chains.points = {{0, 0, 0}, {1, 0, 0}, {2, 0, 0}, {3, 0, 0}};
  chains.offsets = {0, 4};
  close_rings(chains);
  EXPECT_TRUE(chains.topology.closed.empty());
  chains.offsets = {0, 9};  // a lie
  close_rings(chains);
  EXPECT_EQ(chains.points.size(), 4U);
}

TEST(ClosedFibers, WithMissingPointsAreBridgedAllRound) {
  FiberBuffer buffer = ring_with_branch();
  lose(buffer, 0);
  lose(buffer, 6);
  MissingPointCounts counts;
  resolve_missing_points(MissingPoints::BRIDGE, buffer, counts);
  EXPECT_EQ(buffer.offsets, (Counts{0, 4, 6}));
  EXPECT_EQ(buffer.topology.closed, (Closed{1, 0}));
  EXPECT_EQ(buffer.topology.joints, (Joints{-1, 6, -1, -1, 6, -1}));
  fiber::FiberAssembly fibers;
  assign(buffer, fibers);
  EXPECT_EQ(fibers.segment_count(), 5U);

  buffer = ring_with_branch();
  for (const std::size_t point : {0, 1, 3}) {
    lose(buffer, point);
  }
  resolve_missing_points(MissingPoints::BRIDGE, buffer, counts);
  EXPECT_EQ(buffer.topology.closed, (Closed{0, 0})) << "two points are no ring";
}

TEST(ClosedFibers, WithMissingPointsAreCutIntoPiecesThatAreJoinedWhereItBegan) {
  FiberBuffer buffer = ring_with_branch();
  lose(buffer, 3);
  MissingPointCounts counts;
  resolve_missing_points(MissingPoints::SPLIT, buffer, counts);
  EXPECT_EQ(buffer.names, (std::vector<std::string>{"ring", "ring[4]", "branch"}));
  EXPECT_EQ(buffer.offsets, (Counts{0, 3, 5, 8}));
  EXPECT_EQ(buffer.topology.closed, (Closed{0, 0, 0}));
  const Joints& joints = buffer.topology.joints;
  EXPECT_EQ(joints, (Joints{0, -1, 6, -1, 0, 6, -1, -1}));
  EXPECT_EQ(buffer.points[4], Eigen::Vector3d(0, 0, 0));
  fiber::FiberAssembly fibers;
  assign(buffer, fibers);
  EXPECT_EQ(fibers.segment_count(), 5U);
}

TEST(ClosedFibers, OfSeveralMessagesAreJoinedWithinTheirOwn) {
  const auto message = [](double height, const FiberBuffer& from) {
    FiberBuffer buffer = from;
    for (Eigen::Vector3d& point : buffer.points) {
      point.z() = height;
    }
    auto made = std::make_shared<FiberMessage>();
    assign(buffer, made->fibers);
    made->names = from.names;
    return made;
  };
  FiberBuffer chain;
  chain.points = {{9, 0, 0}, {9, 1, 0}};
  chain.offsets = {0, 2};
  chain.radii = {0.1};
  chain.names = {"chain"};
  MergedFibers merged;
  merged.merge({message(0, chain), message(1, ring_with_branch()), message(2, chain),
                message(3, ring_with_branch())});
  const fiber::FiberAssembly& fibers = merged.message()->fibers;
  ASSERT_EQ(fibers.fiber_count(), 6U);
  EXPECT_EQ(fibers.topology().closed, (Closed{0, 1, 0, 0, 1, 0}));
  const Joints joints = fibers.topology().joints;
  ASSERT_EQ(joints.size(), 20U);
  EXPECT_EQ(joints[4], joints[7]);
  EXPECT_EQ(joints[14], joints[17]);
  EXPECT_NE(joints[4], joints[14]) << "the same number in two messages is not one place";
  EXPECT_EQ(std::count(joints.begin(), joints.end(), -1), 16);
  EXPECT_EQ(fibers.points()[2], Eigen::Vector3d(0, 0, 1));
  EXPECT_EQ(fibers.points()[7], Eigen::Vector3d(0, 0, 1));
}

}  // namespace
}  // namespace fiber_proximity_ros
