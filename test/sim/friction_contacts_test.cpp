// Energies, forces and matrices of friction in contacts, and Newton steps of rods in contact,
// against differences and dense algebra.

#include <gtest/gtest.h>

#include <cmath>

#include "test/sim/contact_system.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

const FrictionAnchors no_anchors;
constexpr double slip_step = 0.01;  // [s]
constexpr double crossed_radius = 0.03;

/// Rods across each other, as near as touching is about.
Rods crossed_rods(Random& random, int count) {
  Rods rods;
  for (int rod = 0; rod < count; ++rod) {
    const double turn = (rod % 2) * M_PI / 2 + random.uniform(-0.3, 0.3);
    const Vector3d along(0.2 * std::cos(turn), 0.2 * std::sin(turn), 0.0);
    const Vector3d middle(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                          2.0 * crossed_radius * rod * random.uniform(0.995, 1.0));
    rods.add(straight(middle - along, middle + along, 7), crossed_radius, rubber(crossed_radius));
  }
  return rods;
}

/// Slips of a micrometre and of millimetres; some stick, some slide.
TEST(FrictionContacts, TheGradientIsThatOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const Rods start = crossed_rods(random, 3);
    const auto table = environment_of(HalfSpaceShape{Vector3d::UnitZ(), -crossed_radius});
    const auto contacts = contacts_with(round % 2 == 0 ? nullptr : table, 0.4);
    ContactSet found = contacts_of(*contacts, start);
    found.begin(start, contacts->friction(), {&start, &no_anchors}, slip_step);
    Rods rods = start;
    const double slip = std::pow(10.0, random.uniform(-6.0, -4.0));
    for (Vector3d& position : rods.positions) {
      position += random.in_cube(slip);
    }
    ContactSet smooth = contacts_of(*contacts, start);
    EXPECT_GT(energy_in(found, rods), energy_in(smooth, rods)) << "friction has energy";
    const VectorXd gradient = full_system(found, rods).gradient;
    const VectorXd expected = gradient_by_differences(
        rods, [&](const Rods& r) { return energy_in(found, r); }, 1e-8);
    ASSERT_LE((gradient - expected).norm(), 1e-4 * gradient.norm()) << "round " << round;
    const VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(full_system(found, rods).hessian)
            .eigenvalues();
    EXPECT_GE(eigenvalues.minCoeff(), -1e-10 * eigenvalues.maxCoeff());
  }
}

/// With twist, friction acts at the surface: on sections and edges as well.
TEST(FrictionContacts, OnSectionsItsDerivativesAreThoseOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 10; ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Rods start = crossed_rods(random, 3);
    const Twist twist(start);
    const auto table = environment_of(HalfSpaceShape{Vector3d::UnitZ(), -crossed_radius});
    const auto contacts = contacts_with(round % 2 == 0 ? nullptr : table, 0.4);
    ContactSet found = contacts_of(*contacts, start);
    ContactSet smooth = found;
    found.begin(start, contacts->friction(), {&start, &no_anchors}, slip_step);
    smooth.begin(start, nullptr, {&start, &no_anchors}, slip_step);
    Rods rods = start;
    const double slip = std::pow(10.0, random.uniform(-6.0, -4.0));
    for (std::size_t node = 0; node < rods.positions.size(); ++node) {
      rods.positions[node] += random.in_cube(slip);
      rods.angles[node] += random.uniform(-slip, slip) / crossed_radius;
    }
    const auto friction_at = [&](const Rods& r) {
      FullSystem all = full_system(found, r);
      const FullSystem without = full_system(smooth, r);
      all.gradient -= without.gradient;
      all.hessian -= without.hessian;
      return all;
    };
    const FullSystem friction = friction_at(rods);
    const VectorXd expected = gradient_by_differences(
        rods, [&](const Rods& r) { return energy_in(found, r) - energy_in(smooth, r); }, 1e-8);
    EXPECT_GT(friction.gradient.norm(), 0.0);
    ASSERT_LE((friction.gradient - expected).norm(), 1e-4 * friction.gradient.norm());
    const Eigen::MatrixXd hessian = derivatives_by_differences(
        rods, [&](const Rods& r) { return friction_at(r).gradient; }, 1e-8);
    ASSERT_LE((friction.hessian - hessian).norm(), 1e-3 * friction.hessian.norm());
  }
}

/// However edges share a contact between them, friction is the coefficient times what presses.
TEST(FrictionContacts, ARodThatSlidesAcrossAnotherHasItsCoefficient) {
  for (const double length : {0.5 * crossed_radius, 2.0 * crossed_radius, 10.0 * crossed_radius}) {
    for (const double place : {0.0, 0.1, 0.3, 0.5}) {
      Rods start;
      const Vector3d x(10.0 * length, 0, 0);
      const Vector3d y(0, 10.0 * length, 0);
      const Vector3d shift(place * length, 0.7 * place * length, 1.98 * crossed_radius);
      start.add(straight(-x, x, 20), crossed_radius, rubber(crossed_radius));
      start.add(straight(shift - y, shift + y, 20), crossed_radius, rubber(crossed_radius));
      const auto contacts = contacts_with(nullptr, 0.4);
      ContactSet found = contacts_of(*contacts, start);
      found.begin(start, contacts->friction(), {&start, &no_anchors}, slip_step);
      Rods rods = start;
      for (std::uint32_t i = rods.first(1); i < rods.end(1); ++i) {
        rods.positions[i].y() += 1e-4;  // along itself: what presses stays as it is
      }
      found.update_distances(rods);
      std::vector<RodForces::ContactForce> forces;
      found.add_forces(rods, forces);
      Vector3d normal = Vector3d::Zero();
      Vector3d friction = Vector3d::Zero();
      for (const RodForces::ContactForce& force : forces) {
        normal += force.normal_force;
        friction += force.friction_force;
      }
      EXPECT_GT(normal.norm(), 0.0);
      EXPECT_NEAR(friction.y(), 0.4 * normal.norm(), 0.02 * normal.norm())
          << "edges of " << length / crossed_radius << " radii, at " << place;
      EXPECT_LE(std::abs(friction.x()), 0.02 * normal.norm());
      // Across what presses, which short edges tilt a little.
      EXPECT_LE(std::abs(friction.z()), 0.08 * normal.norm());
    }
  }
}

/// A Newton step of a stepper with one iteration, beside one by dense algebra.
TEST(Coupling, ConjugateGradientsSolveAsDenseAlgebraDoes) {
  SCOPED_TRACE(seed_message());
  Random random(5);
  for (int round = 0; round < 10; ++round) {
    const Rods rods = crossed_rods(random, 4);
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods);
    ASSERT_GT(energy_in(found, rods), 0.0);
    FullSystem full = full_system(found, rods);
    EXPECT_TRUE(has_coupling(found.terms()));
    for (std::uint32_t node = 0; node < rods.positions.size(); ++node) {
      full.hessian.diagonal().segment<3>(3 * Eigen::Index{node}).array() +=
          rods.masses[node] / (slip_step * slip_step);
    }
    const VectorXd expected = -full.hessian.llt().solve(full.gradient);
    StepperOptions options;
    options.max_iterations = 1;
    Stepper stepper(rods, {}, options, contacts_with(nullptr));
    stepper.step(slip_step);
    VectorXd moved(expected.size());
    for (std::uint32_t node = 0; node < rods.positions.size(); ++node) {
      moved.segment<3>(3 * Eigen::Index{node}) =
          stepper.rods().positions[node] - rods.positions[node];
    }
    const VectorXd error = moved - expected;
    EXPECT_LE(error.dot(full.hessian * error), 4e-4 * expected.dot(full.hessian * expected));
  }
}

}  // namespace
}  // namespace fiber::test
