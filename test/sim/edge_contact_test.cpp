// The potential of two polylines near each other, against differences and against what does not
// know of edges.

#include "src/sim/contact/edge_contact.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <ostream>

#include "test/sim/contact_system.hpp"
#include "test/sim/polyline.hpp"
#include "test/sim/tunnelling.hpp"
#include "test/support/random.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double edge_radius = 0.01;
constexpr double edge_touching = 2.0 * edge_radius;
constexpr double edge_width = 2.0 * Barrier::half_width * edge_touching;
constexpr double room =
    4.0 * edge_radius;  // that polylines are moved by after contacts are looked for

double nearest_distance(const Rods& rods) {
  double nearest = std::numeric_limits<double>::infinity();
  const std::vector<Vector3d>& x = rods.positions;
  for (std::uint32_t a = rods.first(0); a + 1 < rods.end(0); ++a) {
    for (std::uint32_t b = rods.first(1); b + 1 < rods.end(1); ++b) {
      nearest = std::min(nearest, edge_distance(x[a], x[a + 1], x[b], x[b + 1]));
    }
  }
  return nearest;
}

void move_second(Rods& rods, const Vector3d& by) {
  for (std::uint32_t i = rods.first(1); i < rods.end(1); ++i) {
    rods.positions[i] += by;
  }
}

/// Moves the second polyline along a way until the two are that far apart; from far away.
/// @returns false if they pass each other
bool bring_to(Rods& rods, const Vector3d& way, double distance) {
  move_second(rods, -0.5 * way);
  for (int i = 0; i < 200; ++i) {
    const double left = nearest_distance(rods) - distance;
    if (left < 1e-12) {
      return left > -1e-6 * edge_width;
    }
    move_second(rods, left * way.normalized());
  }
  return nearest_distance(rods) - distance < 1e-6 * edge_width;
}

struct Kind {
  const char* name;
  double angle;  // between the polylines [rad]
  double bend;   // at their nodes
  bool has_ends_in_reach;
  bool is_aligned;  // nodes beside nodes
};

/// Two polylines of this kind, as near each other as the barrier is about.
Rods random_pair(Random& random, const Kind& kind) {
  for (;;) {
    Rods rods;
    const double length = edge_radius * std::pow(10.0, random.uniform(-0.5, 1.0));
    const int edges = random.integer(3, 6);
    const Vector3d along = random.direction();
    const Vector3d across = along.unitOrthogonal();
    const Vector3d other = std::cos(kind.angle) * along + std::sin(kind.angle) * across;
    rods.add(polyline(random, along, edges, length, kind.bend), edge_radius, rubber(edge_radius));
    std::vector<Vector3d> points = polyline(random, other, edges, length, kind.bend);
    const double shift = kind.is_aligned ? random.integer(-1, 1) : random.uniform(-1.0, 1.0);
    const double to_middle = kind.has_ends_in_reach ? edges : shift;
    for (Vector3d& point : points) {
      point += to_middle * length * along + 0.3 * edges * length * (along - other);
    }
    rods.add(points, edge_radius, rubber(edge_radius));
    // In a plane, bent rods meet in hollows.
    const Vector3d normal = along.cross(across);
    const Vector3d way =
        kind.has_ends_in_reach ? Vector3d(normal + 0.3 * random.direction()) : normal;
    if (bring_to(rods, way, edge_touching + (random.uniform(0.02, 0.98) - 0.5) * edge_width)) {
      return rods;
    }
  }
}

std::ostream& operator<<(std::ostream& out, const Kind& kind) { return out << kind.name; }

class PairOfKind : public testing::TestWithParam<Kind> {};

/// The energy of all pairs of edges together: a contact may move from one pair to another.
TEST_P(PairOfKind, HasTheGradientOfItsEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 60; ++round) {
    const Rods rods = random_pair(random, GetParam());
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods, room);
    const double energy = energy_in(found, rods);
    ASSERT_GT(energy, 0.0);
    const VectorXd gradient = full_system(found, rods).gradient;
    const VectorXd expected = gradient_by_differences(
        rods, [&](const Rods& r) { return energy_in(found, r); }, 2e-9);
    ASSERT_LE((gradient - expected).norm(), 2e-5 * (gradient.norm() + energy / edge_width))
        << "round " << round << ", nearest " << nearest_distance(rods) / edge_touching
        << "\nfound\n"
        << gradient.transpose() << "\nexpected\n"
        << expected.transpose();
    // Without torque: forces are along what is between points.
    Vector3d force = Vector3d::Zero();
    Vector3d torque = Vector3d::Zero();
    for (Eigen::Index i = 0; i < gradient.size(); i += 3) {
      force += gradient.segment<3>(i);
      torque += rods.positions[static_cast<std::size_t>(i / 3)].cross(gradient.segment<3>(i));
    }
    EXPECT_LE(force.norm(), 1e-11 * gradient.norm());
    EXPECT_LE(torque.norm(), 1e-11 * gradient.norm());
  }
}

TEST_P(PairOfKind, HasAPositiveSemidefiniteHessianThatKnowsNoTranslation) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 20; ++round) {
    const Rods rods = random_pair(random, GetParam());
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods, room);
    const Eigen::MatrixXd hessian = full_system(found, rods).hessian;
    EXPECT_LE((hessian - hessian.transpose()).norm(), 1e-13 * hessian.norm());
    const VectorXd eigenvalues =
        Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(hessian).eigenvalues();
    EXPECT_GT(eigenvalues.maxCoeff(), 0.0);
    EXPECT_GE(eigenvalues.minCoeff(), -1e-10 * eigenvalues.maxCoeff());
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      VectorXd translation = VectorXd::Zero(hessian.rows());
      for (Eigen::Index i = axis; i < translation.size(); i += 3) {
        translation[i] = 1.0;
      }
      EXPECT_LE((hessian * translation).norm(), 1e-10 * eigenvalues.maxCoeff());
    }
  }
}

/// While one polyline slides along the other, through wherever nodes pass nodes and edges.
TEST_P(PairOfKind, NeitherEnergyNorGradientJump) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (int round = 0; round < 6; ++round) {
    const Rods start = random_pair(random, GetParam());
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, start, 2.0 * room);
    const Vector3d normal = (start.positions[1] - start.positions[0])
                                .cross(start.positions.back() - start.positions[start.first(1)]);
    const Vector3d way = room * (random.direction() - 0.2 * normal.normalized()).normalized();
    // The largest jump from one place to the next on the way there, by how far apart places are.
    const auto largest_jumps = [&](int places) {
      std::pair<double, double> jumps(0.0, 0.0);
      double energy = 0.0;
      VectorXd gradient;
      for (int i = 0; i <= places; ++i) {
        Rods rods = start;
        move_second(rods, (static_cast<double>(i) / places - 0.5) * way);
        if (nearest_distance(rods) < edge_touching - 0.1 * edge_width) {
          gradient.resize(0);  // so near that forces grow from place to place
          continue;
        }
        const double energy_here = energy_in(found, rods);
        const VectorXd gradient_here = full_system(found, rods).gradient;
        if (gradient.size() > 0) {
          jumps.first = std::max(jumps.first, std::abs(energy_here - energy));
          jumps.second = std::max(jumps.second, (gradient_here - gradient).norm());
        }
        energy = energy_here;
        gradient = gradient_here;
      }
      return jumps;
    };
    const auto coarse = largest_jumps(400);
    const auto fine = largest_jumps(4000);
    EXPECT_LE(fine.first, 0.3 * coarse.first) << "round " << round;
    EXPECT_LE(fine.second, 0.3 * coarse.second) << "round " << round;
  }
}

/// However edges lie to each other.
TEST_P(PairOfKind, IsInfiniteFromTheLeastDistanceDownAndNowhereAboveTheInnerOne) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  int infinite = 0;
  for (int round = 0; round < 300; ++round) {
    Rods rods = random_pair(random, GetParam());
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods, room);
    move_second(rods, random.in_cube(0.1 * edge_touching));
    const double distance = nearest_distance(rods);
    const Barrier barrier = Barrier::around(edge_touching, 1.0);
    const double energy = energy_in(found, rods);
    infinite += std::isinf(energy) ? 1 : 0;
    EXPECT_TRUE(std::isfinite(energy) || distance <= barrier.inner) << distance / edge_touching;
    EXPECT_TRUE(std::isinf(energy) || distance > barrier.min_distance())
        << distance / edge_touching;
    EXPECT_EQ(energy == 0.0, distance >= barrier.outer) << distance / edge_touching;
  }
  expect_enough(infinite, 20);
}

INSTANTIATE_TEST_SUITE_P(Kinds, PairOfKind,
                         testing::Values(Kind{"crossing", 1.2, 0.0, false, false},
                                         Kind{"crossing_bent", 1.0, 0.4, false, false},
                                         Kind{"crossing_in_nodes", 1.5707963267948966, 0.0, false,
                                              true},
                                         Kind{"parallel", 0.0, 0.0, false, false},
                                         Kind{"parallel_nodes_beside_nodes", 0.0, 0.0, false, true},
                                         Kind{"nearly_parallel", 1e-7, 0.0, false, false},
                                         Kind{"at_a_small_angle", 0.02, 0.0, false, false},
                                         Kind{"hollows_and_humps", 0.1, 0.8, false, false},
                                         Kind{"past_ends", 0.3, 0.2, true, false},
                                         Kind{"end_to_end", 0.0, 0.0, true, true}),
                         [](const auto& kind) { return std::string(kind.param.name); });

/// The end of a rod that stands on another, straight and finely sampled one.
TEST(EdgeContact, ANodeThatSlidesAlongAStraightRodFeelsNoNodes) {
  for (const double edge : {0.1 * edge_radius, 0.2 * edge_radius}) {
    Rods rods;
    rods.add(straight({-5.0 * edge_radius, 0, 0}, {5.0 * edge_radius, 0, 0},
                      static_cast<int>(std::lround(10.0 * edge_radius / edge))),
             edge_radius, rubber(edge_radius));
    rods.add(straight({0, 0, 0.99 * edge_touching}, {0, 0, 10.0 * edge_touching}, 3), edge_radius,
             rubber(edge_radius));
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods, room);
    const double energy = energy_in(found, rods);
    for (int i = 0; i < 100; ++i) {
      move_second(rods, {0.013 * edge, 0, 0});
      EXPECT_NEAR(energy_in(found, rods), energy, 1e-3 * energy) << i;
      const Eigen::VectorXd gradient = full_system(found, rods).gradient;
      EXPECT_LE(std::abs(gradient[3 * static_cast<Eigen::Index>(rods.first(1))]),
                0.02 * gradient.lpNorm<Eigen::Infinity>());
    }
  }
}

/// Seed 22 of the campaign: a node in the hollow of two edges that slides past the free end of the
/// shorter one. The node between the edges counted half less then.
TEST(EdgeContact, ANodeThatSlidesFromAHollowPastAnEndFeelsNoJump) {
  constexpr double slope = 0.2;
  constexpr double length = 0.2 * edge_touching;  // of the shorter edge
  const Vector3d up(0, std::sin(slope), 0);
  const Vector3d along(std::cos(slope), 0, 0);
  Rods rods;
  rods.add({20.0 * length * (up - along), Vector3d::Zero(), length * (up + along)}, edge_radius,
           rubber(edge_radius));
  const Vector3d node(0, 1.017 * edge_touching, 0);
  const Vector3d end(0, 0, 10.0 * edge_touching);
  rods.add({node - end, node, node + end}, edge_radius, rubber(edge_radius));
  const auto contacts = contacts_with(nullptr);
  ContactSet found = contacts_of(*contacts, rods, room);
  constexpr int places = 1000;
  const Vector3d way(0.1 * length, 0, 0);
  move_second(rods, -0.5 * way);
  double last = energy_in(found, rods);
  for (int i = 0; i < places; ++i) {
    move_second(rods, way / places);
    const double energy = energy_in(found, rods);
    EXPECT_NEAR(energy, last, 1e-3 * last) << "place " << i;
    last = energy;
  }
}

/// Side by side each node has a contact, wherever it is between those of the other rod.
TEST(EdgeContact, RodsSideBySideAreHeldApartAllAlong) {
  const double edge = 5.0 * edge_radius;
  const auto force_at = [&](double offset) {
    Rods rods;
    rods.add(straight({0, 0, 0}, {10 * edge, 0, 0}, 10), edge_radius, rubber(edge_radius));
    const Vector3d shift((offset + 2.0) * edge, 0, 0.98 * edge_touching);
    rods.add(straight(shift, shift + Vector3d(5 * edge, 0, 0), 5), edge_radius,
             rubber(edge_radius));
    const auto contacts = contacts_with(nullptr);
    ContactSet found = contacts_of(*contacts, rods);
    const Eigen::VectorXd gradient = full_system(found, rods).gradient;
    double force = 0.0;
    for (std::uint32_t i = rods.first(1); i < rods.end(1); ++i) {
      force -= gradient[3 * static_cast<Eigen::Index>(i) + 2];
    }
    return force;
  };
  const double of_node = force_at(0.5) / 11.0;  // six nodes of one, five of the other
  for (const double offset : {0.0, 0.3, 0.7, 1.0}) {
    const bool is_aligned = offset == 0.0 || offset == 1.0;
    EXPECT_NEAR(force_at(offset), (is_aligned ? 12.0 : 11.0) * of_node, 1e-9 * of_node) << offset;
  }
}

}  // namespace
}  // namespace fiber::test
