// Nothing passes through objects that sweep rods at 5 m/s, turning on the way. Whether something
// has is seen from where things are alone: by sides and crossings_behind that cannot change
// otherwise.

#include <gtest/gtest.h>

#include <cmath>

#include "test/environment/random_shapes.hpp"
#include "test/sim/throw.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double sweep_speed = 5.0;  // [m/s]
constexpr double swept_radius = 0.002;

/// A motion at this sweep_speed, with a turn about any axis through the origin of the object.
PoseInTime random_sweep(Random& random, const Isometry3d& from, const Vector3d& velocity,
                        double turn_rate) {
  const Vector3d axis = random.direction();
  return [=](double time) {
    Isometry3d pose = from;
    pose.translation() += time * velocity;
    pose.linear() = Eigen::AngleAxisd(turn_rate * time, axis) * from.linear();
    return pose;
  };
}

double random_sweep_step(Random& random) { return 1.0 / random.uniform(60.0, 480.0); }

/// Rods in front of a plate stay in front of it, or leave over its rim.
TEST(SweepingObstacles, PlatesKeepNodesOnTheirSide) {
  SCOPED_TRACE(seed_message());
  Random random(71);
  constexpr double thickness = 1e-4;
  for (int repeat = 0; repeat < rounds(50); ++repeat) {
    const Vector3d size(2.0, 2.0, thickness);
    const Shape plate = repeat % 3 == 0   ? Shape(BoxShape{size})
                        : repeat % 3 == 1 ? Shape(box_mesh(size, 2))
                                          : Shape(CylinderShape{1.0, thickness});
    Rods rods;
    for (int rod = 0; rod < 3; ++rod) {
      const Vector3d middle(0.0, 0.62 * (rod - 1), 0.0);  // out of reach of each other
      rods.add(chain(random, middle, 10, 0.3), swept_radius, rubber(swept_radius));
    }
    double lowest = 0.0;
    for (const Vector3d& position : rods.positions) {
      lowest = std::min(lowest, position.z());
    }
    const Isometry3d from = at_place({0.0, 0.0, lowest - 2.0 * swept_radius});
    const auto motion =
        random_sweep(random, from, sweep_speed * Vector3d::UnitZ(), random.uniform(-3.0, 3.0));
    Stepper stepper(rods, elastic(standard_gravity), StepperOptions{},
                    contacts_with_moving({moving("plate", plate, motion)}, 0.3));
    const double step = random_sweep_step(random);
    for (int i = 0; i * step < 0.15; ++i) {
      stepper.step(step);
      ASSERT_TRUE(all_finite(stepper.rods())) << "sweep " << repeat << ", step " << i;
      const Isometry3d pose = stepper.moving_obstacles()->poses()[0];
      for (const Vector3d& position : stepper.rods().positions) {
        const Vector3d local = pose.inverse() * position;
        ASSERT_TRUE(local.z() > 0.5 * thickness + 0.9 * swept_radius ||
                    local.head<2>().norm() > 0.99)
            << "sweep " << repeat << ", step " << i << ": " << local.transpose();
      }
    }
    ASSERT_FALSE(stepper.moving_obstacles()->longest_lag(stepper.time())) << "sweep " << repeat;
  }
}

/// How often a chain crosses the half-plane behind a post, from its one side to the other less the
/// other way round: what does not pass through the post does not change that.
int crossings_behind(const Rods& rods, const Isometry3d& post, const Vector3d& behind) {
  const Vector3d axis = post.linear() * Vector3d::UnitZ();
  const Vector3d normal = axis.cross(behind);
  const Vector3d within = normal.cross(axis);  // in the half-plane, across the post
  int count = 0;
  for (std::uint32_t i = 0; i + 1 < rods.positions.size(); ++i) {
    const Vector3d a = rods.positions[i] - post.translation();
    const Vector3d b = rods.positions[i + 1] - post.translation();
    const double at_a = normal.dot(a);
    const double at_b = normal.dot(b);
    if ((at_a > 0.0) != (at_b > 0.0)) {
      const Vector3d crossing = a + at_a / (at_a - at_b) * (b - a);
      count += within.dot(crossing) > 0.0 ? (at_a > 0.0 ? 1 : -1) : 0;
    }
  }
  return count;
}

/// A thin post sweeps a cable that is held at both ends, and takes it along.
TEST(SweepingObstacles, PostsTakeCablesAlong) {
  SCOPED_TRACE(seed_message());
  Random random(72);
  int touched = 0;
  for (int repeat = 0; repeat < rounds(50); ++repeat) {
    const double thin = random.uniform(0.0005, 0.004);
    const Shape post = repeat % 3 == 0   ? Shape(CylinderShape{thin, 4.0})
                       : repeat % 3 == 1 ? Shape(CapsuleShape{thin, 4.0})
                                         : Shape(box_mesh({thin, thin, 4.0}, 1));
    Rods rods;
    rods.add(straight({-0.3, 0.0, 0.0}, {0.3, 0.0, 0.0}, 6 + repeat % 20), swept_radius,
             rubber(swept_radius));
    const auto last = static_cast<std::uint32_t>(rods.positions.size() - 1);
    auto held = std::make_unique<Attachment>();
    for (const std::uint32_t node : {0U, last}) {
      Attachment::Hold hold;
      hold.node = node;
      const Vector3d place = rods.positions[node];
      hold.placement = [place](double /*time*/) { return Placement{place, {}, {}}; };
      held->add(rods, hold);
    }
    Effects effects = elastic();
    effects.push_back(std::move(held));
    const Isometry3d from =
        Isometry3d(Eigen::Translation3d(random.uniform(-0.1, 0.1), -0.02, 0.0) *
                   Eigen::AngleAxisd(random.uniform(-0.7, 0.7), random.direction()));
    const Vector3d behind = -Vector3d::UnitY();
    const auto motion =
        random_sweep(random, from, sweep_speed * Vector3d::UnitY(), random.uniform(-4.0, 4.0));
    Stepper stepper(rods, effects, StepperOptions{},
                    contacts_with_moving({moving("post", post, motion)}, 0.3));
    ASSERT_EQ(crossings_behind(rods, from, behind), 0);
    const double step = random_sweep_step(random);
    for (int i = 0; i * step < 0.04; ++i) {
      stepper.step(step);
      ASSERT_TRUE(all_finite(stepper.rods())) << "sweep " << repeat << ", step " << i;
      const Isometry3d pose = stepper.moving_obstacles()->poses()[0];
      ASSERT_EQ(crossings_behind(stepper.rods(), pose, behind), 0)
          << "sweep " << repeat << ", step " << i;
    }
    touched += stepper.rods().positions[last / 2].y() > 0.01 ? 1 : 0;
    ASSERT_FALSE(stepper.moving_obstacles()->longest_lag(stepper.time())) << "sweep " << repeat;
  }
  expect_enough(touched, 25);
}

}  // namespace
}  // namespace fiber::test
