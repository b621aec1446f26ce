// Energies, forces and matrices of contacts, against differences and dense algebra.

#include <gtest/gtest.h>

#include <Eigen/Dense>
#include <cmath>
#include <limits>

#include "sim/contact_scenes.hpp"
#include "sim/found_contacts.hpp"
#include "sim/random_rods.hpp"
#include "sim/tunnelling.hpp"
#include "support/error_of.hpp"
#include "support/random.hpp"

namespace fiber::test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double step_length = 0.01;  // [s]

Eigen::Index index_of(std::uint32_t node) { return Eigen::Index{3} * node; }

/// Rods that lie across each other in a heap of the size of an edge or two.
Rods heap(Random& random, int rod_count, double bend = 0.5) {
  Rods rods;
  for (int rod = 0; rod < rod_count; ++rod) {
    std::vector<Vector3d> points{random.in_cube(0.3)};
    Vector3d direction = (random.in_cube(0.03) - points[0]).normalized();
    for (int edge = 0; edge < 4; ++edge) {
      points.push_back(points.back() + random.uniform(0.1, 0.2) * direction);
      direction = (direction + bend * random.direction()).normalized();
    }
    rods.add(points, 0.03, rubber(0.03));
  }
  return rods;
}

/// What contacts add to the equations of all rods, as full vectors and matrices.
struct FullSystem {
  VectorXd gradient;
  MatrixXd hessian;
};

FullSystem full_system(Contacts& contacts, const Rods& rods) {
  const auto size = static_cast<Eigen::Index>(3 * rods.positions.size());
  std::vector<PackSystem> lanes;
  std::vector<RodSystem> systems;
  std::vector<RodSystem*> pointers;
  lanes.reserve(rods.count());
  systems.reserve(rods.count());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    lanes.emplace_back(rods.node_count(rod), 3);
    systems.emplace_back(lanes.back(), rod % lane_count);
    pointers.push_back(&systems.back());
  }
  contacts.add_derivatives(rods, pointers);
  FullSystem full{VectorXd::Zero(size), MatrixXd::Zero(size, size)};
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    const Eigen::Index first = index_of(rods.first(rod));
    const std::size_t count = lanes[rod].size();
    for (std::size_t c = 0; c < count; ++c) {
      const Eigen::Index column = first + static_cast<Eigen::Index>(c);
      full.gradient[column] = systems[rod].gradient(c);
      for (std::size_t r = c; r < std::min(count, c + half_bandwidth(3) + 1); ++r) {
        const Eigen::Index row = first + static_cast<Eigen::Index>(r);
        full.hessian(row, column) = full.hessian(column, row) = systems[rod].hessian(r, c);
      }
    }
  }
  // Unknowns in lanes of their own, node by node.
  std::vector<std::size_t> places;
  for (std::size_t node = 0; node < rods.positions.size(); ++node) {
    places.push_back(3 * node * lane_count);
  }
  using Spread = Eigen::Map<VectorXd, 0, Eigen::InnerStride<lane_count>>;
  for (Eigen::Index c = 0; c < size; ++c) {
    VectorXd unit = VectorXd::Unit(size * lane_count, c * lane_count);
    VectorXd column = VectorXd::Zero(size * lane_count);
    contacts.add_coupling(places, unit.data(), column.data());
    full.hessian.col(c) += Spread(column.data(), size);
  }
  return full;
}

/// By central differences of a function of the rods.
template <class Function>
VectorXd differences(Rods rods, const Function& energy) {
  constexpr double difference = 1e-7;
  VectorXd gradient(3 * rods.positions.size());
  for (Eigen::Index i = 0; i < gradient.size(); ++i) {
    double& x = rods.positions[static_cast<std::size_t>(i / 3)][i % 3];
    const double middle = x;
    x = middle + difference;
    const double after = energy(rods);
    x = middle - difference;
    gradient[i] = (after - energy(rods)) / (2.0 * difference);
    x = middle;
  }
  return gradient;
}

struct Found {
  std::unique_ptr<Contacts> contacts;
  std::unique_ptr<Contacts> without_friction;
};

/// Contacts of rods that have moved a little in the step.
Found found(Rods& rods, const std::shared_ptr<const Environment>& environment, Random& random) {
  Found found{contacts_with(environment, 0.4), contacts_with(environment)};
  found.contacts->begin_step(rods, {0.0, step_length});
  found.without_friction->begin_step(rods, {0.0, step_length});
  for (Vector3d& position : rods.positions) {
    position += random.in_cube(2e-5);  // some stick, some slide
  }
  for (Contacts* contacts : {found.contacts.get(), found.without_friction.get()}) {
    find_and_accept(*contacts, rods);
  }
  return found;
}

std::shared_ptr<const Environment> random_obstacle(Random& random) {
  switch (random.integer(0, 3)) {
    case 0:
      return environment_of(SphereShape{0.2});
    case 1:
      return environment_of(BoxShape{Vector3d(0.3, 0.2, 0.1)});
    case 2:
      return environment_of(CylinderShape{0.1, 0.5});
    default:
      return environment_of(HalfSpaceShape{});
  }
}

TEST(Contacts, GradientIsThatOfTheEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  std::size_t contact_count = 0;
  for (int repeat = 0; repeat < 40; ++repeat) {
    // Where rods are bent, how edges share a contact is not part of the gradient.
    Rods rods = heap(random, 3, 0.0);
    const Found both = found(rods, repeat % 2 == 0 ? nullptr : random_obstacle(random), random);
    contact_count += both.contacts->points().size();
    // Normal forces follow the rods; friction holds those, and directions, of the last iteration.
    const VectorXd expected =
        differences(rods,
                    [&](const Rods& r) { return measured_energy(*both.without_friction, r); }) +
        differences(rods, [&](const Rods& r) { return accepted_energy(*both.contacts, r); });
    measured_energy(*both.without_friction, rods);
    const VectorXd gradient = full_system(*both.contacts, rods).gradient;
    EXPECT_LE((gradient - expected).norm(), 1e-4 * (gradient.norm() + 1.0)) << "repeat " << repeat;
  }
  expect_enough(contact_count, std::size_t{41});
}

TEST(Contacts, BlocksAndCouplingAreTheWholeHessian) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Rods rods = heap(random, 3);
    if (repeat % 2 == 1) {
      for (const std::uint32_t node : {0U, 2U, 7U}) {
        rods.held.push_back({node, rods.positions[node]});
      }
    }
    const Found both = found(rods, repeat < 10 ? nullptr : random_obstacle(random), random);
    const FullSystem full = full_system(*both.without_friction, rods);
    MatrixXd expected = MatrixXd::Zero(full.hessian.rows(), full.hessian.cols());
    for (const ContactPoint& point : both.without_friction->points()) {
      MatrixXd jacobian = MatrixXd::Zero(3, expected.cols());
      const auto add = [&](std::uint32_t node, double weight) {
        const bool held = repeat % 2 == 1 && (node == 0 || node == 2 || node == 7);
        jacobian.middleCols<3>(index_of(node)) +=
            (held ? 0.0 : weight) * Eigen::Matrix3d::Identity();
      };
      add(point.edge_a, 1.0 - point.s);
      add(point.edge_a + 1, point.s);
      if (!point.is_obstacle()) {
        add(point.edge_b, point.t - 1.0);
        add(point.edge_b + 1, -point.t);
      }
      expected += jacobian.transpose() *
                  (point.stiffness * point.normal * point.normal.transpose()) * jacobian;
    }
    EXPECT_LE((full.hessian - expected).norm(), 1e-8 * (1e4 + expected.norm()));
    EXPECT_EQ(both.contacts->has_coupling(), false) << "before derivatives were added";
  }
}

TEST(Contacts, HeldNodesHaveNoGradient) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  Rods rods = heap(random, 3);
  for (std::uint32_t node = 0; node < rods.positions.size(); ++node) {
    rods.held.push_back({node, rods.positions[node]});
  }
  const Found both = found(rods, nullptr, random);
  const FullSystem full = full_system(*both.contacts, rods);
  EXPECT_EQ(full.gradient.norm(), 0.0);
  EXPECT_LE(full.hessian.norm(), 1e-8 * 1e4);
}

TEST(Contacts, ForcesOfFibersBalance) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  for (int repeat = 0; repeat < 20; ++repeat) {
    Rods rods = heap(random, 4);
    const Found both = found(rods, nullptr, random);
    const auto totals = [&rods](const VectorXd& gradient) {
      std::pair<Vector3d, Vector3d> total(Vector3d::Zero(), Vector3d::Zero());
      for (std::uint32_t node = 0; node < rods.positions.size(); ++node) {
        const Vector3d force = gradient.segment<3>(index_of(node));
        total.first += force;
        total.second += rods.positions[node].cross(force);
      }
      return total;
    };
    // Friction is between the axes, so that it has a moment about them: normal forces have none.
    const VectorXd with = full_system(*both.contacts, rods).gradient;
    EXPECT_LE(totals(with).first.norm(), 1e-11 * with.norm());
    const VectorXd without = full_system(*both.without_friction, rods).gradient;
    EXPECT_LE(totals(without).first.norm(), 1e-11 * without.norm());
    EXPECT_LE(totals(without).second.norm(), 1e-11 * without.norm());
  }
}

TEST(Contacts, ConjugateGradientsSolveAsDenseAlgebraDoes) {
  SCOPED_TRACE(seed_message());
  Random random(5);
  for (int repeat = 0; repeat < 10; ++repeat) {
    // Crossed rods that touch by little, so that a Newton step is neither shortened nor halved.
    Rods rods;
    const double radius = 0.01;
    for (int rod = 0; rod < 4; ++rod) {
      const double turn = (rod % 2) * M_PI / 2 + random.uniform(-0.3, 0.3);
      const Vector3d along(0.2 * std::cos(turn), 0.2 * std::sin(turn), 0.0);
      const Vector3d middle(0.02 * random.uniform(-1.0, 1.0), 0.02 * random.uniform(-1.0, 1.0),
                            rod * 1.99 * radius);
      rods.add(straight(middle - along, middle + along, 7), radius, rubber(radius));
    }
    const auto contacts = contacts_with(nullptr);
    contacts->begin_step(rods, {0.0, step_length});
    find_and_accept(*contacts, rods);
    ASSERT_GE(contacts->points().size(), 3U);
    FullSystem full = full_system(*contacts, rods);
    for (std::uint32_t node = 0; node < rods.positions.size(); ++node) {
      full.hessian.diagonal().segment<3>(index_of(node)).array() +=
          rods.masses[node] / (step_length * step_length);
    }
    const VectorXd expected = -full.hessian.llt().solve(full.gradient);
    StepperOptions options;
    options.iterations = 1;
    Stepper stepper(rods, {}, options, contacts_with(nullptr));
    stepper.step(step_length);
    VectorXd moved(expected.size());
    for (std::uint32_t node = 0; node < rods.positions.size(); ++node) {
      moved.segment<3>(index_of(node)) = stepper.rods().positions[node] - rods.positions[node];
    }
    const VectorXd error = moved - expected;
    EXPECT_LE(error.dot(full.hessian * error), 4e-4 * expected.dot(full.hessian * expected));
  }
}

/// Sum of the forces on the rods before an index [N], and of how many contacts.
struct Force {
  Vector3d total = Vector3d::Zero();
  std::size_t count = 0;
};

Force force_on(const Rods& rods, std::uint32_t edges,
               const std::shared_ptr<const Environment>& environment) {
  const auto contacts = contacts_with(environment);
  contacts->begin_step(rods, {0.0, step_length});
  find_and_accept(*contacts, rods);
  Force force;
  for (const ContactPoint& point : contacts->points()) {
    if (point.edge_a < edges) {
      force.total += point.stiffness * point.depth * point.normal;
      ++force.count;
    }
  }
  return force;
}

/// A rod along x whose middle node is lifted by some height, and another across it at x.
Rods crossed(double bend, double x, double depth) {
  constexpr double radius = 0.01;
  Rods rods;
  std::vector<Vector3d> points = straight({-0.2, 0.0, 0.0}, {0.2, 0.0, 0.0}, 8);
  for (Vector3d& point : points) {
    point.z() = -bend * std::abs(point.x());
  }
  rods.add(points, radius, rubber(radius));
  const double z = -bend * std::abs(x) + (2.0 * radius - depth) * std::sqrt(1.0 + bend * bend);
  rods.add(straight({x, -0.1, z}, {x, 0.1, z}, 3), radius, rubber(radius));
  return rods;
}

/// How deep the last rod, of three edges, is in the first, of eight, by all pairs of edges.
double depth_at(const Rods& rods) {
  double nearest = std::numeric_limits<double>::infinity();
  const std::vector<Vector3d>& x = rods.positions;
  for (std::size_t a = 0; a < 8; ++a) {
    for (std::size_t b = 9; b < 12; ++b) {
      nearest = std::min(nearest, edge_distance(x[a], x[a + 1], x[b], x[b + 1]));
    }
  }
  return rods.radii[0] + rods.radii[1] - nearest;
}

class Sliding : public testing::TestWithParam<double> {};

TEST_P(Sliding, FromEdgeToEdgeTheForceIsThatOfOneContact) {
  const double depth = 0.001;
  const double whole = force_on(crossed(GetParam(), 0.025, depth), 9, nullptr).total.norm();
  Force last;
  for (double x = -0.08; x <= 0.08; x += 2e-5) {
    const Force force = force_on(crossed(GetParam(), x, depth), 9, nullptr);
    EXPECT_LE(force.count, 2U) << x;
    // In a hollow two edges share it, whose normals differ.
    const double expected = whole / depth * depth_at(crossed(GetParam(), x, depth));
    EXPECT_NEAR(force.total.norm(), expected, (GetParam() < 0.0 ? 0.3 : 1e-6) * whole) << x;
    if (x > -0.08) {
      // The normal turns at a node of the hollow side.
      EXPECT_LE(std::abs(force.total.norm() - last.total.norm()), 0.01 * last.total.norm()) << x;
      EXPECT_LE((force.total - last.total).norm(),
                (0.01 + 2.1 * std::max(0.0, -GetParam())) * last.total.norm())
          << x;
    }
    last = force;
  }
}

INSTANTIATE_TEST_SUITE_P(Bends, Sliding, testing::Values(0.0, 0.05, 0.2, -0.05, -0.2));

TEST(FiberContact, RodsSideBySideAreHeldApartAllAlong) {
  constexpr double radius = 0.01;
  const double edge = 0.05;
  for (const double offset : {0.0, 0.1, 0.5, 0.9, 1.0, 2.25}) {
    Rods rods;
    rods.add(straight({0.0, 0.0, 0.0}, {10 * edge, 0.0, 0.0}, 10), radius, rubber(radius));
    const Vector3d shift(offset * edge, 0.0, 1.9 * radius);
    rods.add(straight(shift, shift + Vector3d(10 * edge, 0.0, 0.0), 10), radius, rubber(radius));
    const Force force = force_on(rods, 11, nullptr);
    EXPECT_GE(force.count, 8U) << "offset " << offset;
    EXPECT_LE(force.count, 22U) << "offset " << offset;
  }
}

TEST(EnvironmentContact, OverAPostTheForceIsThatOfOneContact) {
  constexpr double radius = 0.01;
  constexpr double post = 0.002;
  const double depth = 0.001;
  const Eigen::Isometry3d across(Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitX()));
  const auto environment = environment_of(CylinderShape{post, 1.0}, across);
  double last = 0.0;
  double whole = 0.0;
  for (double x = 0.0; x <= 0.15; x += 5e-5) {
    Rods rods;
    const double z = radius + post - depth;
    rods.add(straight({x - 0.2, 0.0, z}, {x + 0.2, 0.0, z}, 8), radius, rubber(radius));
    const double force = force_on(rods, 9, environment).total.norm();
    whole = whole == 0.0 ? force : whole;
    EXPECT_NEAR(force, whole, 0.3 * whole) << x;
    if (x > 0.0) {
      EXPECT_NEAR(force, last, 0.01 * whole) << x;
    }
    last = force;
  }
}

TEST(EnvironmentContact, ARodThatLiesFlatRestsOnItsNodes) {
  constexpr double radius = 0.01;
  Rods rods;
  const double z = 0.9 * radius;
  rods.add(straight({0.0, 0.0, z}, {0.5, 0.0, z}, 10), radius, rubber(radius));
  EXPECT_EQ(force_on(rods, 11, environment_of(HalfSpaceShape{})).count, 11U);
}

TEST(ContactOptions, AreChecked) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
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
