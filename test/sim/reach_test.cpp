// The limits of holds by the length of their rod.

#include "src/sim/scene/reach.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/support/error_of.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(Reach, IsTheLengthBetweenHolds) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 10), 0.01, rubber(0.01));
  rods.add(straight({0, 1, 0}, {2, 1, 0}, 10), 0.01, rubber(0.01));
  Attachment attachment;
  attachment.add(rods, pin(2, {0.2, 0, 0}));
  attachment.add(rods, pin(9, {0.9, 0, 0}));
  attachment.add(rods, pin(4, {0.4, 0, 0}));
  const std::vector<ReachLimit> limits = reach_limits(rods, attachment, 0, 4, 0.0, 0.5);
  ASSERT_EQ(limits.size(), 2U);
  EXPECT_EQ(limits[0].node, 2U);
  EXPECT_NEAR(limits[0].rest_length, 0.2, 1e-12);
  EXPECT_NEAR(limits[0].radius, 0.3, 1e-12);
  EXPECT_EQ(limits[1].node, 9U);
  EXPECT_NEAR(limits[1].rest_length, 0.5, 1e-12);
  EXPECT_EQ(limits[1].center, Vector3d(0.9, 0, 0));
  EXPECT_TRUE(reach_limits(rods, attachment, 1, 4, 0.0, 0.5).empty());
  EXPECT_NEAR(rest_length(rods, 1), 2.0, 1e-12);
}

TEST(Reach, SharesLeadAsFarAsLimitsAllow) {
  Random random(2);
  int cut = 0;
  for (int round = 0; round < 1000; ++round) {
    SCOPED_TRACE(seed_message() + ", round " + std::to_string(round));
    const Vector3d from = random.in_cube();
    const Vector3d to = from + std::pow(10.0, random.uniform(-3.0, 3.0)) * random.in_cube();
    std::vector<ReachLimit> limits;
    for (int i = random.integer(0, 3); i > 0; --i) {
      limits.push_back({0, 0, random.in_cube(), 0.0, random.uniform(0.0, 2.0)});
    }
    const double share = reachable_share(limits, from, to);
    ASSERT_GE(share, 0.0);
    ASSERT_LE(share, 1.0);
    const auto excess = [&](double s) {
      double most = -1.0;
      for (const ReachLimit& limit : limits) {
        const double radius = std::max(limit.radius, (from - limit.center).norm());
        most = std::max(most, (from + s * (to - from) - limit.center).norm() - radius);
      }
      return most;
    };
    const double rounding = 1e-9 * (1.0 + (to - from).norm());
    for (int i = 0; i <= 10; ++i) {
      ASSERT_LE(excess(0.1 * i * share), rounding);
    }
    if (share < 1.0) {
      ++cut;
      EXPECT_GT(excess(share + 0.01 * (1.0 - share)), -rounding);
    }
  }
  EXPECT_GT(cut, 100);
}

/// The formula that limits speeds, against a rod whose end is pulled along it.
TEST(Reach, APulledRodIsStretchedBySpeedOverThatOfSound) {
  constexpr double strain = 0.1;
  constexpr double length = 1.0;
  constexpr int segments = 200;
  Rods rods;
  rods.add(straight({0, 0, 0}, {length, 0, 0}, segments), 0.01, rubber(0.01));
  const double speed = pull_speed(rods.sections[0], strain);
  const double sound = speed / strain;
  EXPECT_NEAR(sound, std::sqrt(1e7 / 1200.0), 1e-9 * sound);
  auto attachment = std::make_unique<Attachment>();
  Attachment::Hold pulled = pin(segments, Vector3d::Zero());
  pulled.max_force = rods.sections[0].stretching_stiffness;
  pulled.placement = [=](double time) {
    return Placement{Vector3d(length + speed * time, 0, 0), Vector3d::Zero(), Vector3d::Zero()};
  };
  attachment->add(rods, pulled);
  Stepper stepper(rods, effects(std::make_unique<Stretch>(), std::move(attachment)), precise());
  const double step = 0.25 * length / segments / sound;
  while (stepper.time() < 0.6 * length / sound) {
    stepper.step(step);
  }
  // The wave is on its way through the rod, and has left the end behind it.
  const Rods& now = stepper.rods();
  for (int i = segments - 1; i > segments * 8 / 10; --i) {
    const double of_edge = (now.positions[i + 1] - now.positions[i]).norm() / now.rest_lengths[i];
    EXPECT_NEAR(of_edge - 1.0, strain, 0.1 * strain) << "edge " << i;
  }
  EXPECT_NEAR(now.positions[0].x(), 0.0, 1e-3);
}

TEST(Stepper, WhatIsNotFiniteIsNamed) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 4), 0.01, rubber(0.01));
  rods.add(straight({0, 1, 0}, {2, 1, 0}, 4), 0.01, rubber(0.01));
  EXPECT_NO_THROW(require_finite(rods));
  const auto message = [](const Rods& bad) -> std::string {
    try {
      require_finite(bad);
    } catch (const std::runtime_error& error) {
      return error.what();
    }
    return "no error";
  };
  Rods far = rods;
  far.positions[7].y() = std::nan("");
  EXPECT_EQ(message(far).find("the step diverges: node 2 of rod 1 has the position ("), 0U)
      << message(far);
  Rods fast = rods;
  fast.velocities[0].x() = std::numeric_limits<double>::infinity();
  EXPECT_NE(message(fast).find("node 0 of rod 0 has the velocity (inf"), std::string::npos);
}

/// Whatever the numbers are, a step has an end.
TEST(Stepper, AStepThatDivergesIsAnError) {
  for (const double speed : {std::nan(""), std::numeric_limits<double>::infinity()}) {
    for (const bool has_contacts : {false, true}) {
      Rods rods;
      rods.add(straight({0, 0, 0.5}, {1, 0, 0.5}, 20), 0.01, rubber(0.01));
      rods.add(straight({0, 0.1, 0.5}, {1, 0.1, 0.5}, 20), 0.01, rubber(0.01));
      rods.velocities[5].x() = speed;
      Stepper stepper(rods, elastic(9.81), {},
                      has_contacts ? contacts_with(environment_of(HalfSpaceShape{})) : nullptr);
      EXPECT_ANY_THROW(stepper.step(1.0 / 240.0)) << speed << ", " << has_contacts;
    }
  }
}

}  // namespace
}  // namespace fiber::test
