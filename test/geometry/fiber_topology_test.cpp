#include "fiber_proximity/geometry/fiber_topology.hpp"

#include <gtest/gtest.h>

#include <string>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "test/support/error_of.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Points = std::vector<Vector3d>;
using Numbers = std::vector<std::uint32_t>;

const Points square_and_tail{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {1, 1, 0}, {2, 2, 0}};
const FiberTopology closed_and_joined{{1, 0}, {-1, -1, 4, -1, 4, -1}, {}};

FiberAssembly square() {
  return {square_and_tail, {0, 4, 6}, {1, 2, 3, 4, 5, 6}, closed_and_joined};
}

TEST(FiberTopology, AClosedFiberHasASegmentMore) {
  const FiberAssembly fibers = square();
  EXPECT_EQ(fibers.offsets(), (Numbers{0, 5, 7}));
  EXPECT_EQ(fibers.segment_count(), 5U);
  EXPECT_EQ(fibers.capsule(3).p1, Vector3d(0, 0, 0));
  EXPECT_EQ(fibers.capsule(3).radius, 4.0);
  EXPECT_EQ(fibers.capsule(0).radius, 2.0);
  EXPECT_TRUE(fibers.is_closed(0));
  EXPECT_FALSE(fibers.is_closed(1));
}

TEST(FiberTopology, GivesBackWhatWasGiven) {
  const FiberAssembly fibers = square();
  EXPECT_EQ(fibers.given_points(), square_and_tail);
  EXPECT_EQ(fibers.given_offsets(), (Numbers{0, 4, 6}));
  EXPECT_EQ(fibers.given_radii(), (std::vector<double>{1, 2, 3, 4, 5, 6}));
  EXPECT_EQ(fibers.topology().closed, closed_and_joined.closed);
  EXPECT_EQ(fibers.topology().joints, closed_and_joined.joints);
  const FiberAssembly chains(square_and_tail, {0, 4, 6}, {1});
  EXPECT_EQ(chains.given_points(), square_and_tail);
  EXPECT_TRUE(chains.topology().closed.empty());
  EXPECT_FALSE(chains.has_topology_of(fibers));
  EXPECT_TRUE(fibers.has_topology_of(square()));
}

TEST(FiberTopology, WhatJoinsNothingIsAChain) {
  const FiberAssembly fibers(square_and_tail, {0, 4, 6}, {1}, {{0, 0}, {7, -1, -1, -1, -1, 8}, {}});
  EXPECT_EQ(fibers.graph(), nullptr);
  const std::vector<LonelyJoint> lonely = lonely_joints({8, 2, -1, 2, -4, 7});
  ASSERT_EQ(lonely.size(), 2U);
  EXPECT_EQ(lonely[0].joint, 8);
  EXPECT_EQ(lonely[0].point, 0U);
  EXPECT_EQ(lonely[1].joint, 7);
  EXPECT_EQ(lonely[1].point, 5U);
}

TEST(FiberTopology, MovesWithPointsAsGivenOrAsStored) {
  FiberAssembly fibers = square();
  Points given = square_and_tail;
  for (Vector3d& point : given) {
    point += Vector3d(0, 0, 7);
  }
  fibers.update_points(given);
  EXPECT_EQ(fibers.points().size(), 7U);
  EXPECT_EQ(fibers.points()[4], Vector3d(0, 0, 7));
  EXPECT_EQ(fibers.given_points(), given);
  Points stored = square().points();
  fibers.update_points(stored);
  EXPECT_EQ(fibers.given_points(), square_and_tail);
  Points taken = given;
  fibers.exchange_points(taken);
  EXPECT_EQ(fibers.given_points(), given);
  fibers.transform(Eigen::Isometry3d(Eigen::Translation3d(0, 0, -7)));
  EXPECT_EQ(fibers.given_points(), square_and_tail);
  stored[4] = {5, 0, 0};
  EXPECT_EQ(error_of([&] { fibers.update_points(stored); }),
            "fibre 0: is closed, and its first point is repeated 5 m away; repeat it where it is, "
            "or leave it out");
  given.pop_back();
  EXPECT_EQ(error_of([&] { fibers.update_points(given); }),
            "update with 5 points for an assembly of 6");
  EXPECT_EQ(fibers.given_points(), square_and_tail);
}

TEST(FiberTopology, JointsMustMeet) {
  Points apart = square_and_tail;
  apart[4] = {1.5, 1, 0};
  const std::string text =
      "joint 4: fibre 0, point 2 and fibre 1, point 0 are 0.5 m apart; points that are joined must "
      "lie within 0.2 m, the largest radius that meets there or 1e-6 of the largest coordinate";
  EXPECT_EQ(error_of([&] { FiberAssembly(apart, {0, 4, 6}, {0.2}, closed_and_joined); }), text);
  EXPECT_EQ(FiberAssembly(apart, {0, 4, 6}, {0.5}, closed_and_joined).fiber_count(), 2U);
  FiberTopology tolerant = closed_and_joined;
  tolerant.joint_tolerance = 0.5;
  EXPECT_EQ(FiberAssembly(apart, {0, 4, 6}, {0.0}, tolerant).fiber_count(), 2U);
  tolerant.joint_tolerance = 0.25;
  EXPECT_EQ(error_of([&] {
              FiberAssembly(apart, {0, 4, 6}, {1.0}, tolerant);
            }),
            "joint 4: fibre 0, point 2 and fibre 1, point 0 are 0.5 m apart; points that are "
            "joined must lie within 0.25 m, the joint_tolerance");
  FiberAssembly moving(square_and_tail, {0, 4, 6}, {0.2}, closed_and_joined);
  EXPECT_EQ(error_of([&] { moving.update_points(apart); }), text);
  EXPECT_EQ(moving.given_points(), square_and_tail);
  moving.update_points(apart, JointCheck::LEFT_OUT);
  EXPECT_EQ(moving.given_points(), apart);
  // What single precision makes of one place.
  apart[4] = square_and_tail[4] + Vector3d(1e-7, 0, 0);
  EXPECT_EQ(FiberAssembly(apart, {0, 4, 6}, {0.0}, closed_and_joined).fiber_count(), 2U);
}

TEST(FiberTopology, ErrorsNameWhatIsWrong) {
  const auto error = [](const FiberTopology& topology) {
    return error_of([&] { FiberAssembly(square_and_tail, {0, 4, 6}, {0.1}, topology); });
  };
  EXPECT_EQ(error({{0, 1}, {}, {}}),
            "fibre 1: is closed and has 2 points, a closed fibre needs at least 3");
  EXPECT_EQ(error({{1}, {}, {}}),
            "closed has 1 value(s) for 2 fibre(s); give none or one per fibre");
  EXPECT_EQ(error({{}, {1, 1}, {}}),
            "joints has 2 value(s) for 6 points; give none or one per point");
  EXPECT_EQ(error({{}, {}, -1.0}), "joint_tolerance is -1 m, it must be at least 0");
}

TEST(FiberTopology, IsTakenAlongWithSomeOfTheFibers) {
  const FiberAssembly swapped = select_fibers(square(), {1, 0});
  EXPECT_EQ(swapped.given_offsets(), (Numbers{0, 2, 6}));
  EXPECT_EQ(swapped.given_radii(), (std::vector<double>{5, 6, 1, 2, 3, 4}));
  EXPECT_EQ(swapped.topology().closed, (std::vector<std::uint8_t>{0, 1}));
  EXPECT_EQ(swapped.topology().joints, (std::vector<std::int32_t>{4, -1, -1, -1, 4, -1}));
  EXPECT_EQ(swapped.points()[6], Vector3d(0, 0, 0));
  EXPECT_EQ(select_fibers(square(), {1}).graph(), nullptr);
}

TEST(FiberTopology, AMotionKeepsIt) {
  const FiberAssembly open({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 0}}, {0, 5}, {0.1});
  const FiberAssembly closed({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {0, 4}, {0.1},
                             {{1}, {}, {}});
  EXPECT_EQ(error_of([&] { require_same_topology(open, closed); }),
            "the fibres change their topology: others are closed or joined after than before; a "
            "motion needs the same");
  require_same_topology(closed, closed);
}

}  // namespace
}  // namespace fiber::test
