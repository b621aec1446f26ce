// Nothing is pressed into anything, however hard holds pull; and holds pull with no more than they
// may.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/trefoil.hpp"
#include "test/sim/tunnelling.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// The least distance of axes of a rod's edges that may touch, in parts of two radii.
double nearest_axes(const Rods& rods) {
  double nearest = std::numeric_limits<double>::infinity();
  const double skip = 4.0 * rods.radii[0];
  for (std::uint32_t a = 0; a + 1 < rods.end(0); ++a) {
    double between = 0.0;
    for (std::uint32_t b = a + 1; b + 1 < rods.end(0); ++b) {
      if (b - a > 2 && between >= skip) {
        nearest = std::min(nearest, edge_distance(rods.positions[a], rods.positions[a + 1],
                                                  rods.positions[b], rods.positions[b + 1]));
      }
      between += rods.rest_lengths[b];
    }
  }
  return nearest / (2.0 * rods.radii[0]);
}

/// An open trefoil whose ends two holds pull apart, with all their force in the end.
class PulledKnot : public testing::TestWithParam<std::uint32_t> {};

TEST_P(PulledKnot, KeepsItsAxesApart) {
  constexpr double radius = 0.004;
  const std::vector<Vector3d> points = open_trefoil(0.02, 60);
  Rods rods;
  rods.add(points, radius, rubber(radius));
  const auto last = static_cast<std::uint32_t>(points.size()) - 1;
  const Vector3d apart = 0.4 * (points.front() - points.back()).normalized();
  const auto drawn = [&](std::uint32_t node, const Vector3d& velocity) {
    Attachment::Hold held = pin(node, points[node]);
    held.placement = [start = points[node], velocity](double time) {
      return Placement{start + time * velocity, Vector3d::Zero(), Vector3d::Zero()};
    };
    return held;
  };
  Effects all = elastic();
  all.push_back(std::make_unique<Damping>(0.01));
  all.push_back(hold(rods, {drawn(0, apart), drawn(last, -apart)}));
  StepperOptions options;
  options.threads = 1;
  options.max_iterations = GetParam();
  Stepper stepper(rods, std::move(all), options, contacts_with(nullptr, 0.1));
  for (int i = 0; i < 240; ++i) {
    stepper.step(1.0 / 240.0);
    ASSERT_GE(nearest_axes(stepper.rods()), 0.9) << "step " << i;
  }
  EXPECT_LE(nearest_axes(stepper.rods()), 1.05) << "it is tight";
  for (const RodForces::HoldForce& held : stepper.forces().holds) {
    EXPECT_NEAR(held.force.norm(), 0.1 * rods.sections[0].stretching_stiffness,
                1e-6 * held.force.norm());
    EXPECT_GT(held.lag, 0.05);
  }
}

INSTANTIATE_TEST_SUITE_P(MostIterations, PulledKnot, testing::Values(4, 100));

/// The shipped pile in 60 segments, each longer than the coil is thick.
TEST(Loads, APileOf60SegmentsKeepsItsAxesApart) {
  constexpr double radius = 0.004;
  std::vector<Vector3d> points;
  for (int i = 0; i <= 60; ++i) {
    const double angle = 2.0 * M_PI * 6.0 * i / 60.0;
    points.emplace_back(0.08 * std::cos(angle), 0.08 * std::sin(angle),
                        0.05 + 0.03 * angle / (2.0 * M_PI));
  }
  Rods rods;
  rods.add(points, radius, solid_round_section(material_preset("silicone_tube"), radius));
  Effects all = elastic(standard_gravity);
  all.push_back(std::make_unique<Damping>(0.01));
  StepperOptions options;
  options.threads = 1;
  options.max_iterations = 3;
  Stepper stepper(rods, std::move(all), options,
                  contacts_with(environment_of(HalfSpaceShape{}), 0.4));
  double nearest = std::numeric_limits<double>::infinity();
  for (int i = 0; i < 720; ++i) {
    stepper.step(1.0 / 240.0);
    nearest = std::min(nearest, nearest_axes(stepper.rods()));
  }
  EXPECT_GE(nearest, 0.9);
  EXPECT_LE(nearest, 1.05) << "nothing has touched";
}

/// One end is fixed, the other drawn away; the force grows to what the hold may, and no further.
TEST(Loads, AHoldPullsWithItsForceAndLags) {
  constexpr double radius = 0.004;
  constexpr double most = 3.0;  // [N]
  Rods rods;
  rods.add(straight(Vector3d::Zero(), {0.5, 0.0, 0.0}, 10), radius, rubber(radius));
  Attachment::Hold drawn = pin(10, {0.5, 0.0, 0.0});
  drawn.max_force = most;
  drawn.placement = [](double time) {
    return Placement{{0.5 + 0.2 * time, 0.0, 0.0}, Vector3d::Zero(), Vector3d::Zero()};
  };
  Effects all = elastic();
  all.push_back(std::make_unique<Damping>(0.001));
  all.push_back(hold(rods, {pin(0, Vector3d::Zero()), drawn}));
  Stepper stepper(rods, std::move(all));
  bool was_weaker = false;
  for (int i = 0; i < 240; ++i) {
    stepper.step(1.0 / 240.0);
    const RodForces::HoldForce held = stepper.forces().holds[1];
    ASSERT_LE(held.force.norm(), most * (1.0 + 1e-12)) << "step " << i;
    ASSERT_EQ(held.max_force, most);
    was_weaker |= held.force.norm() < 0.5 * most && held.lag < 1e-4;
  }
  EXPECT_TRUE(was_weaker);
  const RodForces forces = stepper.forces();
  EXPECT_NEAR(forces.holds[1].force.x(), most, 1e-6);
  EXPECT_NEAR(forces.tensions[5], most, 0.01 * most);
  const double stretched = 0.5 * (1.0 + most / rods.sections[0].stretching_stiffness);
  EXPECT_NEAR(stepper.rods().positions[10].x(), stretched, 1e-3 * stretched);
  EXPECT_NEAR(forces.holds[1].lag, 0.7 - stretched, 1e-3);
}

}  // namespace
}  // namespace fiber::test
