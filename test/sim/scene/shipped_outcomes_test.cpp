// Scenes of the package do what they say.
#include <gtest/gtest.h>

#include <cmath>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "test/support/source_folder.hpp"

namespace fiber {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

SimScene shipped(const std::string& name) {
  const auto file = test::source_folder() / "config/sim" / (name + ".yaml");
  return make_sim_scene(read_sim_scene(load_yaml(file), mesh_files(file.parent_path())), 1);
}

void run_until(SimScene& scene, double time) {
  while (scene.stepper->time() < time) {
    scene.advance();
  }
}

/// The points of a fibre.
std::vector<Vector3d> points_of(const SimScene& scene, std::uint32_t rod = 0) {
  const Rods& rods = scene.stepper->rods();
  return {rods.positions.begin() + rods.first(rod), rods.positions.begin() + rods.end(rod)};
}

/// By how much the last edge points lower than level [rad].
double drop_of(const std::vector<Vector3d>& points) {
  const Vector3d last = points.back() - points[points.size() - 2];
  return std::atan2(-last.z(), last.x());
}

/// How often a curve goes round an upright line, seen from above; between its ends it is closed.
double turns_round(const std::vector<Vector3d>& points, const Vector2d& line) {
  double angle = 0.0;
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Vector2d a = points[i].head<2>() - line;
    const Vector2d b = points[(i + 1) % points.size()].head<2>() - line;
    angle += std::atan2(a.x() * b.y() - a.y() * b.x(), a.dot(b));
  }
  return angle / (2.0 * M_PI);
}

/// The force with which contacts press on an object of the environment [N].
double pressure_on(const SimScene& scene, std::uint32_t object) {
  double sum = 0.0;
  for (const RodForces::ContactForce& contact : scene.stepper->forces().contacts) {
    if (contact.other_rod == RodForces::ContactForce::obstacle && contact.object == object) {
      sum += contact.normal_force.norm();
    }
  }
  return sum;
}

/// It springs back by a little when the force ends, and stays bent.
TEST(ShippedOutcome, TheBentWireKeepsItsBend) {
  SimScene scene = shipped("bend_wire");
  run_until(scene, 2.45);
  const double under_force = drop_of(points_of(scene));
  run_until(scene, 4.5);
  const double after = drop_of(points_of(scene));
  EXPECT_GT(under_force, 65.0 * M_PI / 180.0);
  EXPECT_GT(after, 45.0 * M_PI / 180.0);
  EXPECT_GT(under_force - after, 3.0 * M_PI / 180.0) << "springs back";
  run_until(scene, 5.5);
  EXPECT_NEAR(drop_of(points_of(scene)), after, 0.02) << "stays";
}

/// The end that is pushed goes 25 cm; what it pushes gives way to the side instead.
TEST(ShippedOutcome, ThePushedRopeGivesWayToTheSide) {
  SimScene scene = shipped("push_rope");
  const std::vector<Vector3d> before = points_of(scene);
  run_until(scene, 4.0);
  const std::vector<Vector3d> after = points_of(scene);
  double width = 0.0;
  for (const Vector3d& point : after) {
    width = std::max(width, std::abs(point.y()));
    EXPECT_LT(point.z(), 0.02) << "it stays on the table";
  }
  EXPECT_NEAR(after.front().x() - before.front().x(), 0.25, 1e-3);
  EXPECT_LT(after.back().x() - before.back().x(), 0.12);
  EXPECT_GT(width, 0.1);
}

/// 35 mm of it are below the rim, and it is no further off the axis than the play lets it.
TEST(ShippedOutcome, ThePlugIsIn) {
  SimScene scene = shipped("plug_in");
  constexpr double half_play = 0.25e-3;
  constexpr double rim = 0.06;
  bool has_touched = false;
  while (scene.stepper->time() < 4.0) {
    scene.advance();
    const std::vector<Vector3d> plug = points_of(scene, 1);
    has_touched = has_touched || pressure_on(scene, 1) > 0.1;
    if (plug[1].z() < rim) {
      // The round of the tip may be where the middle may not yet be; 0.05 of the radius give way.
      EXPECT_LE(plug[1].head<2>().cwiseAbs().maxCoeff(), half_play + 0.05 * 0.004);
    }
  }
  EXPECT_TRUE(has_touched) << "it comes down beside the hole's middle";
  const std::vector<Vector3d> plug = points_of(scene, 1);
  EXPECT_NEAR(plug[1].z(), rim - 0.035, 1e-3);
  EXPECT_LE(plug[0].head<2>().norm(), 0.5e-3);
  EXPECT_EQ(points_of(scene, 0).back(), plug[0]) << "the cable is on it";
}

TEST(ShippedOutcome, TheCableIsClosedAroundThePosts) {
  SimScene scene = shipped("close_cable");
  run_until(scene, 5.0);
  const std::vector<Vector3d> points = points_of(scene);
  EXPECT_LT((points.front() - points.back()).norm(), 2.5 * 0.004) << "its ends meet";
  for (const double x : {-0.09, 0.09}) {
    EXPECT_NEAR(std::abs(turns_round(points, {x, 0.0})), 1.0, 1e-6) << "the post at " << x;
  }
  for (std::uint32_t post = 1; post < 3; ++post) {
    EXPECT_GT(pressure_on(scene, post), 0.1) << "post " << post - 1;
  }
}

/// It is around all three, is taut, and presses on each.
TEST(ShippedOutcome, TheRubberBandHoldsThePosts) {
  SimScene scene = shipped("rubber_band");
  run_until(scene, 6.0);
  const std::vector<Vector3d> points = points_of(scene);
  const Rods& rods = scene.stepper->rods();
  for (const Vector2d& post : {Vector2d(0.0, 0.0), Vector2d(0.08, -0.03), Vector2d(0.08, 0.03)}) {
    EXPECT_NEAR(std::abs(turns_round(points, post)), 1.0, 1e-6) << "post at " << post.transpose();
    double pressure = 0.0;
    for (const RodForces::ContactForce& contact : scene.stepper->forces().contacts) {
      if (contact.other_rod == RodForces::ContactForce::obstacle &&
          (contact.point.head<2>() - post).norm() < 0.012) {
        pressure += contact.normal_force.norm();
      }
    }
    EXPECT_GT(pressure, 1.0) << "post at " << post.transpose();
  }
  for (std::uint32_t i = 0; i + 1 < rods.node_count(0); ++i) {
    EXPECT_LT(rods.positions[i].z(), 0.04) << "below the posts' ends";
    const double length = (rods.positions[i + 1] - rods.positions[i]).norm();
    EXPECT_GT(length / rods.rest_lengths[i], 1.2) << "it is stretched, edge " << i;
  }
}

/// Also where a cable falls on bends of itself, whose edges share contacts, and gives back what
/// they were pressed together by.
TEST(ShippedOutcome, FrictionInAPileIsWithinCoulombsCone) {
  constexpr double coefficient = 0.4;  // as the scene has it
  SimScene scene = shipped("pile");
  std::size_t sliding = 0;
  while (scene.stepper->time() < 0.6) {
    scene.advance();
    for (const RodForces::ContactForce& force : scene.stepper->forces().contacts) {
      const double normal = force.normal_force.norm();
      const double friction = force.friction_force.norm();
      ASSERT_LE(friction, 1.02 * coefficient * normal + 1e-6)
          << "edges " << force.edge << " and " << force.other_edge << " at "
          << scene.stepper->time() << " s";
      sliding += friction > 0.98 * coefficient * normal ? 1 : 0;
    }
  }
  EXPECT_GT(sliding, 1000U);
}

}  // namespace
}  // namespace fiber
