// Motions of the kinds that have failed in other libraries, named after the reports.
#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "validation/geometry/hard_motions.hpp"
#include "validation/geometry/motion_score.hpp"

namespace fiber::test {
namespace {

constexpr double asked_tolerance = 1e-6;  // [m]

/// A segment of one metre along x, turned about the vertical by an angle and tilted by another
/// [rad], whose middle comes down from a height to as far below [m].
HardMotion descending(double turn, double tilt, double height, double radius) {
  HardMotion motion;
  const Eigen::Vector3d half(0.5 * std::cos(turn) * std::cos(tilt),
                             0.5 * std::sin(turn) * std::cos(tilt), 0.5 * std::sin(tilt));
  const Eigen::Vector3d above(0.0, 0.0, height);
  motion.a_before = {above - half, above + half};
  motion.a_after = {-above - half, -above + half};
  motion.b_before =
      motion.b_after = {Eigen::Vector3d(-0.5, 0.0, 0.0), Eigen::Vector3d(0.5, 0.0, 0.0)};
  motion.radius_a = motion.radius_b = radius;
  return motion;
}

/// The answer is right by our own truth, certain, and encloses this time closely.
void expect_contact(const HardMotion& motion, double time) {
  const ContactTime answer = contact_time(motion.motions(), asked_tolerance);
  EXPECT_TRUE(answer.hit && answer.certain);
  EXPECT_LE(answer.lower, time * (1.0 + 1e-14));
  EXPECT_GE(answer.upper, time * (1.0 - 1e-14));
  EXPECT_LT(answer.upper - answer.lower, 20.0 * asked_tolerance);
  EXPECT_FALSE(judge(motion, asked_tolerance, answer).has_wrong_answers());
}

/// When the axes are as near as two radii, from a height of which the middle comes down twice.
double time_of_fall(double height, double radius) {
  return (height - 2.0 * radius) / (2.0 * height);
}

// fcl#637: valid input on which continuousCollide ends the process.
TEST(FailuresElsewhere, Fcl637ValidInputIsAnswered) {
  for (const double radius : {0.0, 1e-12, 1e-3, 0.2}) {
    for (const double turn : {0.0, 1e-9, 0.3, 1.5707963267948966}) {
      const HardMotion motion = descending(turn, 0.0, 1.0, radius);
      if (radius > 0.0) {
        expect_contact(motion, time_of_fall(1.0, radius));
      } else {
        EXPECT_TRUE(contact_time(motion.motions(), asked_tolerance).hit);
      }
    }
  }
  // Standing still, apart and in contact; without length.
  HardMotion still = descending(0.3, 0.0, 1.0, 0.1);
  still.a_after = still.a_before;
  EXPECT_FALSE(contact_time(still.motions(), asked_tolerance).hit);
  still.a_before = still.a_after = still.b_before;
  EXPECT_EQ(contact_time(still.motions(), asked_tolerance).upper, 0.0);
  HardMotion points = descending(0.0, 0.0, 1.0, 0.1);
  points.a_before[1] = points.a_before[0];
  points.a_after[1] = points.a_after[0];
  expect_contact(points, time_of_fall(1.0, 0.1));
}

// python-fcl#11: two calls with the same bodies and motions answer differently.
TEST(FailuresElsewhere, PythonFcl11AnswersAreTheSameEveryTime) {
  const HardMotion motion = descending(0.7, 0.0, 10.0, 0.5);
  const ContactTime first = contact_time(motion.motions(), asked_tolerance);
  for (int i = 0; i < 100; ++i) {
    const ContactTime again = contact_time(motion.motions(), asked_tolerance);
    EXPECT_TRUE(again.hit == first.hit && again.lower == first.lower &&
                again.upper == first.upper && again.certain == first.certain);
  }
}

// python-fcl#38: bodies far apart that meet in the middle of a long way are not seen to.
TEST(FailuresElsewhere, PythonFcl38ALongWayThroughAnother) {
  for (const double height : {1.0, 10.0, 1e3, 1e6}) {
    expect_contact(descending(0.7, 0.0, height, 0.5), time_of_fall(height, 0.5));
  }
}

// ipc-toolkit#225: edges nearly parallel, which cross as seen from above.
TEST(FailuresElsewhere, IpcToolkit225NearlyParallelEdgesThatCross) {
  for (double turn = 0.1; turn > 1e-18; turn *= 0.1) {
    expect_contact(descending(turn, 0.0, 1.0, 1e-3), time_of_fall(1.0, 1e-3));
    expect_contact(descending(-turn, 0.0, 1.0, 0.1), time_of_fall(1.0, 0.1));
  }
}

// ipc-toolkit#232: edges nearly parallel, one end of which comes first.
TEST(FailuresElsewhere, IpcToolkit232NearlyParallelEdgesTilted) {
  for (double tilt = 0.1; tilt > 1e-18; tilt *= 0.1) {
    const double lead = 0.5 * std::sin(tilt);  // [m] of the lower end, which is above the other
    expect_contact(descending(0.0, tilt, 1.0, 1e-3), (1.0 - 2e-3 - lead) / 2.0);
    expect_contact(descending(0.0, -tilt, 1.0, 0.1), (1.0 - 0.2 - lead) / 2.0);
  }
}

}  // namespace
}  // namespace fiber::test
