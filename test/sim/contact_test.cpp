// Energies, forces and matrices of contacts with obstacles and of friction, against differences and
// dense algebra.

#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "test/environment/random_shapes.hpp"
#include "test/sim/contact_system.hpp"
#include "test/sim/tunnelling.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double step_length = 0.01;  // [s]
constexpr double rod_radius = 0.03;
constexpr double obstacle_width =
    2.0 * Barrier::half_width * rod_radius;  // of the barrier of an obstacle

/// A chain of a few edges.
std::vector<Vector3d> chain(Random& random, double bend) {
  std::vector<Vector3d> points{random.in_cube(0.1)};
  Vector3d direction = random.direction();
  for (int edge = 0; edge < 4; ++edge) {
    points.push_back(points.back() + random.uniform(0.1, 0.2) * direction);
    direction = (direction + bend * random.direction()).normalized();
  }
  return points;
}

/// How far all edges are from an environment's only object, as the detector says: less the radius.
double distance_from(const Environment& environment, const Rods& rods) {
  const FiberAssembly fibers(rods.positions, rods.offsets, rods.radii);
  QueryOptions query;
  query.type = QueryType::CLOSEST;
  query.margin = 10.0;
  QueryResult result;
  environment.query(fibers, query, {}, result);
  return result.contacts.empty() ? std::numeric_limits<double>::infinity()
                                 : result.contacts.front().distance;
}

/// Convex ones, and meshes and octrees, which are of many parts.
std::vector<Shape> shapes() {
  return {SphereShape{0.2},
          BoxShape{Vector3d(0.3, 0.2, 0.1)},
          CylinderShape{0.1, 0.5},
          CylinderShape{0.005, 2.0},
          CapsuleShape{0.02, 0.4},
          ConeShape{0.2, 0.3},
          HalfSpaceShape{},
          PlaneShape{},
          box_mesh({0.3, 0.2, 0.1}, 2)};
}

/// A rod that touches this shape: where its surface is so far from the shape's [m].
Rods rod_at(Random& random, const std::shared_ptr<const Environment>& environment,
            double distance) {
  for (;;) {
    Rods rods;
    rods.add(chain(random, random.chance(0.5) ? 0.0 : 0.4), rod_radius, rubber(rod_radius));
    const Vector3d away = random.direction() + Vector3d(0.0, 0.0, 1.0);
    for (Vector3d& position : rods.positions) {
      position += 2.0 * away;
    }
    for (int i = 0; i < 200; ++i) {
      const double left = distance_from(*environment, rods) - distance;
      if (std::isinf(left) || left < -1e-6) {
        break;
      }
      if (left < 1e-10) {
        return rods;
      }
      for (Vector3d& position : rods.positions) {
        position -= left * away.normalized();
      }
    }
  }
}

class OfShape : public testing::TestWithParam<std::size_t> {
 protected:
  std::shared_ptr<const Environment> environment_ = environment_of(
      shapes()[GetParam()],
      Eigen::Isometry3d(Eigen::AngleAxisd(0.5, Vector3d(1.0, 2.0, 3.0).normalized())));
};

TEST_P(OfShape, TheGradientIsThatOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(GetParam());
  for (int round = 0; round < 20; ++round) {
    const Rods rods = rod_at(random, environment_, random.uniform(-0.4, 0.4) * obstacle_width);
    const auto contacts = contacts_with(environment_);
    ContactSet found = contacts_of(*contacts, rods, rod_radius);
    const double energy = energy_in(found, rods);
    ASSERT_GT(energy, 0.0);
    const VectorXd gradient = full_system(found, rods).gradient;
    const VectorXd expected = gradient_by_differences(
        rods, [&](const Rods& r) { return energy_in(found, r); }, 5e-9);
    ASSERT_LE((gradient - expected).norm(), 1e-5 * (gradient.norm() + energy / obstacle_width))
        << "round " << round << "\nfound\n"
        << gradient.transpose() << "\nexpected\n"
        << expected.transpose();
  }
}

TEST_P(OfShape, TheHessianIsPositiveSemidefinite) {
  SCOPED_TRACE(seed_message());
  Random random(20 + GetParam());
  for (int round = 0; round < 20; ++round) {
    const Rods rods = rod_at(random, environment_, random.uniform(-0.4, 0.4) * obstacle_width);
    const auto contacts = contacts_with(environment_);
    ContactSet found = contacts_of(*contacts, rods, rod_radius);
    const Eigen::MatrixXd hessian = full_system(found, rods).hessian;
    const VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues();
    EXPECT_GT(eigenvalues.maxCoeff(), 0.0);
    EXPECT_GE(eigenvalues.minCoeff(), -1e-10 * eigenvalues.maxCoeff());
    EXPECT_FALSE(has_coupling(found.terms()));
  }
}

/// Wherever a rod is in a step, and however it has turned since contacts were looked for.
TEST_P(OfShape, TheEnergyIsInfiniteFromTheLeastDistanceDownAndNowhereAboveTheInnerOne) {
  SCOPED_TRACE(seed_message());
  Random random(40 + GetParam());
  const Barrier barrier = Barrier::around(rod_radius, 1.0);
  int infinite = 0;
  for (int round = 0; round < 100; ++round) {
    Rods rods = rod_at(random, environment_, 0.0);
    const auto contacts = contacts_with(environment_);
    ContactSet found = contacts_of(*contacts, rods, 2.0 * rod_radius);
    const Vector3d together = random.in_cube(2.0 * obstacle_width);
    for (Vector3d& position : rods.positions) {
      position += together + random.in_cube(0.3 * rod_radius);
    }
    const double distance = distance_from(*environment_, rods) + rod_radius;
    const double energy = energy_in(found, rods);
    infinite += std::isinf(energy) ? 1 : 0;
    EXPECT_TRUE(std::isfinite(energy) || distance <= barrier.inner) << distance / rod_radius;
    EXPECT_TRUE(std::isinf(energy) || distance > barrier.min_distance()) << distance / rod_radius;
    EXPECT_EQ(energy == 0.0, distance >= barrier.outer) << distance / rod_radius;
  }
  expect_enough(infinite, 10);
}

/// No share that is allowed leads a distance to lose more than four fifths of what it has.
TEST_P(OfShape, StepsKeepAFifthOfEachDistance) {
  SCOPED_TRACE(seed_message());
  Random random(60 + GetParam());
  const Barrier barrier = Barrier::around(rod_radius, 1.0);
  int shortened = 0;
  for (int round = 0; round < rounds(500); ++round) {
    const Rods rods = rod_at(random, environment_, random.uniform(-0.3, 1.0) * obstacle_width);
    const auto contacts = contacts_with(environment_);
    ContactSet found = contacts_of(*contacts, rods, 10.0 * rod_radius);
    found.update_distances(rods);
    std::vector<Vector3d> displacements;
    const Vector3d together = random.in_cube(5.0 * rod_radius);
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      displacements.push_back(together +
                              random.in_cube(random.chance(0.5) ? rod_radius : obstacle_width));
    }
    std::vector<double> shares{1.0};
    std::vector<Vector3d> ends(rods.positions.size());
    found.bound_step(rods, displacements, {0}, shares, ends);
    shortened += shares[0] < 1.0 ? 1 : 0;
    const double gap = distance_from(*environment_, rods) + rod_radius - barrier.min_distance();
    for (int i = 1; i <= 20; ++i) {
      Rods moved = rods;
      for (std::size_t node = 0; node < moved.positions.size(); ++node) {
        moved.positions[node] += shares[0] * i / 20.0 * displacements[node];
      }
      const double left = distance_from(*environment_, moved) + rod_radius - barrier.min_distance();
      ASSERT_GE(left, 0.2 * gap * (1.0 - 1e-6)) << "share " << shares[0] * i / 20.0;
    }
  }
  expect_enough(shortened, 10);
}

INSTANTIATE_TEST_SUITE_P(Shapes, OfShape, testing::Range(std::size_t{0}, shapes().size()));

/// Rods across each other, as near as touching is about.
Rods crossed_rods(Random& random, int count) {
  Rods rods;
  for (int rod = 0; rod < count; ++rod) {
    const double turn = (rod % 2) * M_PI / 2 + random.uniform(-0.3, 0.3);
    const Vector3d along(0.2 * std::cos(turn), 0.2 * std::sin(turn), 0.0);
    const Vector3d middle(random.uniform(-0.02, 0.02), random.uniform(-0.02, 0.02),
                          2.0 * rod_radius * rod * random.uniform(0.995, 1.0));
    rods.add(straight(middle - along, middle + along, 7), rod_radius, rubber(rod_radius));
  }
  return rods;
}

const FrictionAnchors no_anchors;

/// Slips of a micrometre and of millimetres; some stick, some slide.
TEST(FrictionContacts, TheGradientIsThatOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 20; ++round) {
    const Rods start = crossed_rods(random, 3);
    const auto table = environment_of(HalfSpaceShape{Vector3d::UnitZ(), -rod_radius});
    const auto contacts = contacts_with(round % 2 == 0 ? nullptr : table, 0.4);
    ContactSet found = contacts_of(*contacts, start);
    found.begin(start, contacts->friction(), {&start.positions, &no_anchors}, step_length);
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

/// However edges share a contact between them, friction is the coefficient times what presses.
TEST(FrictionContacts, ARodThatSlidesAcrossAnotherHasItsCoefficient) {
  for (const double length : {0.5 * rod_radius, 2.0 * rod_radius, 10.0 * rod_radius}) {
    for (const double place : {0.0, 0.1, 0.3, 0.5}) {
      Rods start;
      const Vector3d x(10.0 * length, 0, 0);
      const Vector3d y(0, 10.0 * length, 0);
      const Vector3d shift(place * length, 0.7 * place * length, 1.98 * rod_radius);
      start.add(straight(-x, x, 20), rod_radius, rubber(rod_radius));
      start.add(straight(shift - y, shift + y, 20), rod_radius, rubber(rod_radius));
      const auto contacts = contacts_with(nullptr, 0.4);
      ContactSet found = contacts_of(*contacts, start);
      found.begin(start, contacts->friction(), {&start.positions, &no_anchors}, step_length);
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
          << "edges of " << length / rod_radius << " radii, at " << place;
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
          rods.masses[node] / (step_length * step_length);
    }
    const VectorXd expected = -full.hessian.llt().solve(full.gradient);
    StepperOptions options;
    options.max_iterations = 1;
    Stepper stepper(rods, {}, options, contacts_with(nullptr));
    stepper.step(step_length);
    VectorXd moved(expected.size());
    for (std::uint32_t node = 0; node < rods.positions.size(); ++node) {
      moved.segment<3>(3 * Eigen::Index{node}) =
          stepper.rods().positions[node] - rods.positions[node];
    }
    const VectorXd error = moved - expected;
    EXPECT_LE(error.dot(full.hessian * error), 4e-4 * expected.dot(full.hessian * expected));
  }
}

TEST(EnvironmentContact, ARodThatLiesFlatRestsOnItsNodes) {
  Rods rods;
  rods.add(straight({0.0, 0.0, rod_radius}, {0.5, 0.0, rod_radius}, 10), rod_radius,
           rubber(rod_radius));
  const auto contacts = contacts_with(environment_of(HalfSpaceShape{}));
  ContactSet found = contacts_of(*contacts, rods);
  const VectorXd gradient = full_system(found, rods).gradient;
  for (Eigen::Index node = 0; node < 11; ++node) {
    EXPECT_LT(gradient[3 * node + 2], 0.0);
    EXPECT_NEAR(gradient[3 * node + 2], gradient[2], 1e-9 * std::abs(gradient[2]));
  }
}

TEST(ContactOptions, AreChecked) {
  for (const double stiffness : {-1.0, nan, infinity}) {
    const std::string value = std::to_string(stiffness) + " N/m, it must be at least 0 and finite";
    FiberContact::Options fiber;
    fiber.stiffness = stiffness;
    EXPECT_EQ(error_of([&] { FiberContact contact(fiber); }), "contact: the stiffness is " + value);
    EnvironmentContact::Options environment;
    environment.stiffness = stiffness;
    EXPECT_EQ(error_of([&] {
                EnvironmentContact contact(environment_of(HalfSpaceShape{}), environment);
              }),
              "environment_contact: the stiffness is " + value);
  }
  for (const double coefficient : {-0.1, nan, infinity}) {
    EXPECT_EQ(error_of([&] {
                Friction friction({coefficient, 1e-3});
              }),
              "friction: the coefficient is " + std::to_string(coefficient) +
                  ", it must be at least 0 and finite");
  }
  for (const double speed : {0.0, -1.0, nan, infinity}) {
    EXPECT_EQ(error_of([&] {
                Friction friction({0.3, speed});
              }),
              "friction: the stick speed is " + std::to_string(speed) +
                  " m/s, it must be positive and finite");
  }
}

}  // namespace
}  // namespace fiber::test
