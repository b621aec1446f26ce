#include "src/geometry/pose_velocity.hpp"

#include <gtest/gtest.h>

#include "test/support/random.hpp"
#include "test/support/rounds.hpp"

namespace fiber::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

/// Where a body of this pose and velocity is after some time.
Isometry3d pose_after(const Isometry3d& pose, const BodyTwist& twist, double time) {
  Isometry3d after = pose;
  after.translation() += time * twist.linear;
  const double rate = twist.angular.norm();
  if (rate > 0.0) {
    after.linear() =
        Eigen::AngleAxisd(time * rate, twist.angular / rate).toRotationMatrix() * pose.linear();
  }
  return after;
}

TEST(PoseVelocity, IsThatOfABodyThatKeepsIt) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < rounds(200); ++round) {
    // Up to 3 rad from frame to frame: more would be less the other way round.
    const BodyTwist twist{random.in_cube(), random.uniform(0.0, 3.0 / 0x1p-3) * random.direction()};
    Isometry3d pose = Isometry3d::Identity();
    pose.linear() =
        Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.direction()).toRotationMatrix();
    pose.translation() = 10.0 * random.in_cube();
    const std::size_t frames = random.integer(2, 6);
    PoseVelocity velocity(frames);
    double time = 0.0;
    for (int i = 0; i < 9; ++i) {
      time += 0x1p-6 * static_cast<double>(random.integer(1, 8));
      velocity.add(1.7e9 + time, pose_after(pose, twist, time));
    }
    EXPECT_EQ(velocity.frame_count(), frames);
    EXPECT_EQ(velocity.time(), 1.7e9 + time);
    EXPECT_LT((velocity.find().linear - twist.linear).norm(), 1e-12);
    EXPECT_LT((velocity.find().angular - twist.angular).norm(), 1e-11);
  }
}

TEST(PoseVelocity, TakesTheMiddleOfWhatTrembles) {
  // Four poses about a line of 1 m/s and 2 rad/s, off by amounts that cancel in least squares.
  PoseVelocity velocity(4);
  const double off[] = {0.25, -0.25, -0.25, 0.25};
  for (int i = 0; i < 4; ++i) {
    Isometry3d pose = Isometry3d::Identity();
    pose.translation().x() = 0.5 * i + off[i];
    pose.linear() = Eigen::AngleAxisd(i + off[i], Vector3d::UnitZ()).toRotationMatrix();
    velocity.add(0.5 * i, pose);
  }
  EXPECT_LT((velocity.find().linear - Vector3d(1, 0, 0)).norm(), 1e-14);
  EXPECT_LT((velocity.find().angular - Vector3d(0, 0, 2)).norm(), 1e-14);
}

TEST(PoseVelocity, BeginsAnewWithWhatDoesNotGoOn) {
  PoseVelocity velocity(3);
  EXPECT_EQ(velocity.frame_count(), 0U);
  EXPECT_EQ(velocity.duration(), 0.0);
  EXPECT_EQ(velocity.find().linear, Vector3d::Zero());
  const auto add = [&](double time, double x) {
    velocity.add(time, Isometry3d(Eigen::Translation3d(x, 0, 0)));
  };
  add(1.0, 0.0);
  add(1.5, 1.0);
  EXPECT_EQ(velocity.find().linear, Vector3d(2, 0, 0));
  EXPECT_EQ(velocity.find().angular, Vector3d::Zero());
  EXPECT_EQ(velocity.duration(), 0.5);
  for (const double time : {1.5, 1.0}) {
    add(time, 5.0);
    EXPECT_EQ(velocity.frame_count(), 1U) << time;
    EXPECT_EQ(velocity.find().linear, Vector3d::Zero());
  }
}

}  // namespace
}  // namespace fiber::test
