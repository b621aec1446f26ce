// The forces that the simulation reports: their sum is the change of momentum, and they are
// those of statics.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/sim/loads.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

double mass_of(const Rods& rods) {
  double mass = 0.0;
  for (const double m : rods.masses) {
    mass += m;
  }
  return mass;
}

/// The sum of the forces of gravity, holds and obstacles [N].
Vector3d outer_forces(const Stepper& stepper) {
  const RodForces forces = stepper.forces();
  Vector3d sum(0.0, 0.0, -standard_gravity * mass_of(stepper.rods()));
  for (const RodForces::ContactForce& contact : forces.contacts) {
    if (contact.other_rod == RodForces::ContactForce::obstacle) {
      sum += contact.normal_force + contact.friction_force;
    }
  }
  for (const RodForces::HoldForce& held : forces.holds) {
    sum += held.force;
  }
  return sum;
}

/// Two cables, one of them held at one end and drawn sideways by a hold, fall on a table and on
/// each other.
TEST(Forces, SumUpToHowMomentumChanges) {
  constexpr double radius = 0.004;
  constexpr double step = 1.0 / 240.0;
  Rods rods;
  rods.add(straight({-0.2, 0.0, 0.02}, {0.2, 0.0, 0.02}, 20), radius, rubber(radius));
  rods.add(straight({0.0, -0.2, 0.04}, {0.05, 0.2, 0.04}, 20), radius, rubber(radius));
  Effects all = elastic(standard_gravity);
  Attachment::Hold drawn = pin(20, rods.positions[41]);
  drawn.rod = 1;
  drawn.placement = [start = rods.positions[41]](double time) {
    return Placement{start + Vector3d(0.3 * time, 0.0, 0.0), Vector3d::Zero(), Vector3d::Zero()};
  };
  all.push_back(hold(rods, {pin(0, rods.positions[0]), drawn}));
  StepperOptions options = precise();
  options.max_iterations = 200;
  options.residual = 1e-8;
  Stepper stepper(rods, std::move(all), options,
                  contacts_with(environment_of(HalfSpaceShape{}), 0.3));
  const double weight = standard_gravity * mass_of(rods);
  double largest_change = 0.0;
  int with_fiber_contacts = 0;
  int with_friction = 0;
  for (int i = 0; i < 120; ++i) {
    const Vector3d before = momentum_of(stepper.rods());
    stepper.step(step);
    const Vector3d change = (momentum_of(stepper.rods()) - before) / step;
    ASSERT_LE((change - outer_forces(stepper)).norm(), 1e-4 * weight) << "step " << i;
    largest_change = std::max(largest_change, change.norm());
    bool has_friction = false;
    for (const RodForces::ContactForce& contact : stepper.forces().contacts) {
      with_fiber_contacts += contact.other_rod != RodForces::ContactForce::obstacle ? 1 : 0;
      has_friction |= contact.friction_force.norm() > 1e-3 * weight;
    }
    with_friction += has_friction ? 1 : 0;
  }
  EXPECT_GT(largest_change, 0.5 * weight);
  EXPECT_GT(with_fiber_contacts, 20);
  EXPECT_GT(with_friction, 20);
}

/// [m] How far a point is from the axis of a rod's edge.
double distance_from_axis(const Rods& rods, std::uint32_t rod, std::uint32_t edge,
                          const Vector3d& point) {
  const std::size_t first = rods.first(rod) + edge;
  return segment_distance(point, point, rods.positions[first], rods.positions[first + 1]).distance;
}

/// A rod that is held by its ends, and one that lies across it, three times as thick or as thin.
TEST(Forces, BetweenRodsOfUnequalRadiiActWhereTheirSurfacesMeet) {
  for (const auto& [below, above] : {std::pair{0.009, 0.003}, {0.003, 0.009}}) {
    SCOPED_TRACE("radii " + std::to_string(below) + " and " + std::to_string(above));
    Rods rods;
    rods.add(straight({-0.1, 0.0, 0.0}, {0.1, 0.0, 0.0}, 9), below, rubber(below));
    const double height = 1.02 * (below + above);
    rods.add(straight({0.0, -0.1, height}, {0.0, 0.1, height}, 9), above, rubber(above));
    Effects all = elastic(standard_gravity);
    all.push_back(hold(rods, {pin(0, rods.positions[0]), pin(9, rods.positions[9])}));
    Stepper stepper(rods, std::move(all), precise(), contacts_with(nullptr));
    std::size_t found = 0;
    for (int i = 0; i < 20; ++i) {
      stepper.step(1.0 / 240.0);
      for (const RodForces::ContactForce& contact : stepper.forces().contacts) {
        const double radius_a = rods.radii[contact.rod];
        const double radius_b = rods.radii[contact.other_rod];
        const double from_a =
            distance_from_axis(stepper.rods(), contact.rod, contact.edge, contact.point);
        const double from_b = distance_from_axis(stepper.rods(), contact.other_rod,
                                                 contact.other_edge, contact.point);
        EXPECT_NE(radius_a, radius_b);
        EXPECT_NEAR(from_a, radius_a, 0.1 * radius_a);
        EXPECT_NEAR(from_b, radius_b, 0.1 * radius_b);
        ++found;
      }
    }
    EXPECT_GE(found, 10U);
  }
}

TEST(Forces, OfAHangingCableAreTheWeightBelow) {
  constexpr double radius = 0.003;
  constexpr int segments = 40;
  Rods rods;
  rods.add(straight(Vector3d::Zero(), {0.0, 0.0, -1.0}, segments), radius, rubber(radius));
  Effects all = elastic(standard_gravity);
  all.push_back(hold(rods, {pin(0, Vector3d::Zero())}));
  Stepper stepper(rods, std::move(all), precise());
  settle(stepper);
  const RodForces forces = stepper.forces();
  const double weight = standard_gravity * mass_of(rods);
  double below = 0.0;
  for (int edge = segments - 1; edge >= 0; --edge) {
    below += standard_gravity * rods.masses[static_cast<std::size_t>(edge) + 1];
    EXPECT_NEAR(forces.tensions[static_cast<std::size_t>(edge)], below, 1e-6 * weight) << edge;
  }
  ASSERT_EQ(forces.holds.size(), 1U);
  EXPECT_LE((forces.holds[0].force - Vector3d(0.0, 0.0, weight)).norm(), 1e-6 * weight);
  EXPECT_EQ(forces.holds[0].node, 0U);
}

/// A cantilever: its clamp bears the weight, and the moment of the weight about it.
TEST(Forces, OfAClampAreThoseOfStatics) {
  constexpr double radius = 0.005;
  constexpr int segments = 40;
  Rods rods;
  rods.add(straight(Vector3d::Zero(), {0.4, 0.0, 0.0}, segments), radius,
           solid_round_section({1e9, 4e8, 1000.0}, radius));
  Effects all = elastic(standard_gravity);
  all.push_back(hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})}));
  Stepper stepper(rods, std::move(all), precise());
  settle(stepper);
  const RodForces forces = stepper.forces();
  const double weight = standard_gravity * mass_of(rods);
  Vector3d moment = Vector3d::Zero();  // of the weight about the clamped end
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    moment +=
        stepper.rods().positions[i].cross(Vector3d(0.0, 0.0, -standard_gravity * rods.masses[i]));
  }
  ASSERT_EQ(forces.holds.size(), 1U);
  const RodForces::HoldForce& held = forces.holds[0];
  EXPECT_LE((held.force - Vector3d(0.0, 0.0, weight)).norm(), 1e-6 * weight);
  EXPECT_GT(moment.norm(), 0.1 * weight * 0.4);
  EXPECT_LE((held.moment + moment).norm(), 1e-4 * moment.norm())
      << held.moment.transpose() << " and " << moment.transpose();
  // Inside, the moment falls to nothing at the free end.
  EXPECT_NEAR(forces.bending_moments[segments / 2].norm(), 0.25 * moment.norm(),
              0.02 * moment.norm());
}

/// In few edges, twisted at its end and bent by its weight, so that what the clamp turns is bent
/// against it: its moment and those of all else add up to nothing.
TEST(Forces, OfAClampThatBendsAndTwistsAreThoseOfStatics) {
  constexpr double radius = 0.005;
  for (const bool is_last : {false, true}) {
    Rods rods;
    std::vector<Vector3d> points = straight(Vector3d::Zero(), {0.4, 0.0, 0.0}, 5);
    if (is_last) {
      std::reverse(points.begin(), points.end());
    }
    rods.add(points, radius, solid_round_section({1e8, 4e7, 1000.0}, radius));
    auto twist = std::make_unique<Twist>(rods);
    const std::uint32_t clamped = is_last ? 5 : 0;
    Loads::Load load;
    load.node = is_last ? 0 : 5;
    load.moment = TimeTable<Vector3d>(Vector3d(0.05, 0.02, 0.0));
    auto loads = std::make_unique<Loads>();
    loads->add(rods, load);
    const Vector3d tangent(is_last ? -1.0 : 1.0, 0.0, 0.0);
    const Vector3d director = rods.directors[is_last ? 4 : 0];
    Effects all = effects(std::make_unique<Gravity>(Vector3d(0.0, 0.0, -standard_gravity)),
                          std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::move(loads),
                          hold(rods, {clamp(clamped, {Vector3d::Zero(), tangent, director})}));
    Stepper stepper(rods, std::move(all), precise());
    settle(stepper);
    const RodForces forces = stepper.forces();
    Vector3d moment = load.moment.at(0.0);
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      moment +=
          stepper.rods().positions[i].cross(Vector3d(0.0, 0.0, -standard_gravity * rods.masses[i]));
    }
    ASSERT_EQ(forces.holds.size(), 1U);
    const Vector3d first = stepper.rods().positions[is_last ? 4 : 1].normalized();
    EXPECT_GT(first.cross(Vector3d::UnitX()).norm(), 0.02) << "it is bent at the clamp";
    EXPECT_LE((forces.holds[0].moment + moment).norm(), 1e-4 * moment.norm())
        << forces.holds[0].moment.transpose() << " and " << moment.transpose();
  }
}

}  // namespace
}  // namespace fiber::test
