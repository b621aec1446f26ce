// Rods that are bent by nature, to a side that their cross-sections carry along.

#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "src/geometry/smallest_rotation.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/energy_bounds.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/error_of.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;
using Points = std::vector<Vector3d>;

/// Stretching, bending and twisting stiffness, mass and inertia per length.
const RodSection curved_section{1e4, 1.0, 0.7, 1.0, 1e-4};

/// Nodes on a helix around z: each is this angle [rad] further about it than the one before.
Points helix(double radius, double pitch, double angle, int segments) {
  Points points;
  for (int i = 0; i <= segments; ++i) {
    const double at = angle * i;
    points.emplace_back(radius * std::cos(at), radius * std::sin(at), pitch * at / (2.0 * M_PI));
  }
  return points;
}

/// A rod with twist whose natural shape is that which it begins with, clamped so at its beginning.
struct NaturalRod {
  Rods rods;
  Effects all;

  explicit NaturalRod(const Points& points) {
    rods.add(points, 0.01, curved_section);
    all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                  std::make_unique<Twist>(rods), std::make_unique<Damping>(0.05));
    set_natural_shape(rods);
  }

  void clamp_beginning() {
    all.push_back(hold(rods, {clamp(0, {rods.positions[0], tangent(0), rods.directors[0]})}));
  }

  Vector3d tangent(std::uint32_t edge) const {
    return (rods.positions[edge + 1] - rods.positions[edge]).normalized();
  }
};

/// The rods as a step that begins with them finds them.
Bend bend_of(const Rods& rods) {
  Bend bend;
  Rods same = rods;
  bend.begin_step(same, {0.0, 1.0});
  return bend;
}

double bend_energy(const Rods& rods) { return energy_of(bend_of(rods), rods, 0); }

Derivatives bend_derivatives(const Rods& rods) { return derivatives_of(bend_of(rods), rods, 0); }

double largest_distance(const Points& a, const Points& b) {
  double largest = 0.0;
  for (std::size_t i = 0; i < a.size(); ++i) {
    largest = std::max(largest, (a[i] - b[i]).norm());
  }
  return largest;
}

/// A planar arc, helices, and what turns by up to a right angle and more at each node.
std::vector<Points> shapes(Random& random) {
  return {helix(1.0, 0.0, 0.1, 30),       helix(1.0, 0.5, 0.3, 40),
          helix(1.0, 0.0, 0.5 * M_PI, 6), helix(1.0, 1.0, 0.5 * M_PI, 12),
          helix(1.0, 0.3, 0.9 * M_PI, 6), random_chain(random, 20, 0.3)};
}

TEST(NaturalCurvature, ARodStaysInItsNaturalShape) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (const Points& points : shapes(random)) {
    for (const bool is_clamped : {false, true}) {
      NaturalRod rod(points);
      if (is_clamped) {
        rod.clamp_beginning();
      }
      Stepper stepper(rod.rods, std::move(rod.all));
      for (int i = 0; i < 200; ++i) {
        stepper.step(0.01);
      }
      EXPECT_LT(largest_distance(stepper.rods().positions, points), 1e-9);
    }
  }
}

TEST(NaturalCurvature, ADisturbedRodComesBackToItsNaturalShape) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (const Points& points : shapes(random)) {
    NaturalRod rod(points);
    rod.clamp_beginning();
    displace(rod.rods, random, 0.05, 0.3);
    rod.rods.positions[0] = points[0];
    Stepper stepper(rod.rods, std::move(rod.all), precise());
    settle(stepper);
    EXPECT_LT(largest_distance(stepper.rods().positions, points), 1e-7);
  }
}

/// The clamp holds an edge's middle as it were: the first edge turns by half of what a node does.
Points exact_arc(double curvature, const Vector3d& tangent, const Vector3d& side, int segments) {
  Points points{Vector3d::Zero()};
  for (int i = 0; i < segments; ++i) {
    const double angle = curvature * (i + 0.5) / segments;
    points.push_back(points.back() +
                     (std::cos(angle) * tangent + std::sin(angle) * side) / segments);
  }
  return points;
}

/// A hose that came off a coil: its plane is that of the clamp's director.
TEST(NaturalCurvature, AClampTurnsThePlaneOfAnArc) {
  constexpr int segments = 50;
  constexpr double curvature = 4.0;
  const Vector3d along = Vector3d::UnitX();
  for (const double angle : {0.0, 0.5, 2.0, -3.0}) {
    for (const bool is_last : {false, true}) {
      SCOPED_TRACE(angle);
      Rods rods;
      rods.add(straight(is_last ? Vector3d(-along) : Vector3d::Zero(),
                        is_last ? Vector3d::Zero() : along, segments),
               0.01, curved_section);
      auto twist = std::make_unique<Twist>(rods);
      const Vector3d director = rods.directors[0];
      const Vector3d side = Vector3d(0.0, 0.6, 0.8);
      set_natural_arc(rods, 0, curvature, 3.0 * side);
      const Eigen::AngleAxisd turn(angle, along);
      auto held =
          hold(rods, {clamp(is_last ? segments : 0, {Vector3d::Zero(), along, turn * director})});
      Stepper stepper(rods,
                      effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                              std::move(twist), std::move(held)),
                      precise());
      settle(stepper);
      Points expected = exact_arc(curvature, is_last ? -along : along, turn * side, segments);
      if (is_last) {
        std::reverse(expected.begin(), expected.end());
      }
      EXPECT_LT(largest_distance(stepper.rods().positions, expected), 1e-6);
      const Vector3d tip = (std::sin(curvature) * (is_last ? -along : along) +
                            (1.0 - std::cos(curvature)) * (turn * side)) /
                           curvature;
      EXPECT_LT((expected[is_last ? 0 : segments] - tip).norm(), 1e-3);
    }
  }
}

TEST(NaturalCurvature, ItsEnergyIsTheSameWhereverARodIsTurned) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (int round = 0; round < 20; ++round) {
    NaturalRod rod(random_chain(random, 6, 0.3));
    displace(rod.rods, random, 0.1, 1.0);
    Rods turned = rod.rods;
    const Eigen::Quaterniond rotation = smallest_rotation(random.direction(), random.direction());
    for (auto* vectors : {&turned.positions, &turned.directors, &turned.start_tangents}) {
      for (Vector3d& v : *vectors) {
        v = rotation * v;
      }
    }
    const double energy = bend_energy(rod.rods);
    EXPECT_GT(energy, 1e-6);
    EXPECT_NEAR(bend_energy(turned), energy, 1e-12 * (1.0 + energy));
  }
}

/// With a natural curvature of zero, rods behave as without one.
TEST(NaturalCurvature, NoneIsThatOfAStraightRod) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  Rods rods;
  rods.add(random_chain(random, 8, 0.3), 0.01, curved_section);
  const Twist twist(rods);
  displace(rods, random, 0.1, 1.0);
  const double energy = bend_energy(rods);
  const Derivatives derivatives = bend_derivatives(rods);
  rods.natural_curvature_vectors.assign(rods.positions.size(), Vector2d::Zero());
  EXPECT_NEAR(bend_energy(rods), energy, 1e-14 * energy);
  const Derivatives found = bend_derivatives(rods);
  EXPECT_LT((found.gradient - derivatives.gradient).norm(), 1e-12 * derivatives.gradient.norm());
  EXPECT_LT((found.hessian - derivatives.hessian).norm(), 1e-12 * derivatives.hessian.norm());
}

/// In the plane of the natural arc the energy is that of Bend, for the excess of the angle.
TEST(NaturalCurvature, BendingInItsPlaneIsThatOfTheExcess) {
  for (const double natural : {0.7, 1.6, 3.0}) {
    for (const double angle : {-1.0, 0.0, 0.5, 2.0}) {
      NaturalRod rod(helix(1.0, 0.0, natural, 2));
      Rods& rods = rod.rods;
      const Vector3d before = rods.positions[1] - rods.positions[0];
      rods.positions[2] = rods.positions[1] + Eigen::AngleAxisd(angle, Vector3d::UnitZ()) * before;
      const double excess = 2.0 * std::sin(0.5 * (angle - natural));
      EXPECT_NEAR(bend_energy(rods), 0.5 * excess * excess / before.norm(), 1e-12);
    }
  }
}

/// A natural turn by half a turn has no side to turn to, and cannot be exceeded.
TEST(NaturalCurvature, AFoldIsTheMost) {
  for (const double natural : {M_PI, 4.0, 100.0}) {
    Rods rods;
    rods.add({{0, 0, 0}, {1, 0, 0}, {1.5, 0.9, 0}}, 0.01, curved_section);
    const Twist twist(rods);
    set_natural_arc(rods, 0, natural / rods.rest_length_at(1), Vector3d::UnitZ());
    EXPECT_NEAR(bend_energy(rods), 0.0, 1e-15);
    EXPECT_NEAR(bend_derivatives(rods).gradient.norm(), 0.0, 1e-8);
  }
}

/// Nothing is left out of the matrix where a rod is as it is by nature.
TEST(NaturalCurvature, ItsHessianIsExactInTheNaturalShape) {
  SCOPED_TRACE(seed_message());
  Random random(5);
  const NaturalRod rod(random_chain(random, 6, 0.3));
  const Eigen::MatrixXd found = bend_derivatives(rod.rods).hessian;
  const Eigen::MatrixXd expected = hessian_by_differences(bend_of(rod.rods), rod.rods, 0, 1e-5);
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-7 * expected.cwiseAbs().maxCoeff());
}

TEST(NaturalCurvature, WithoutTwistItHasSizeAlone) {
  Rods rods;
  rods.add(helix(1.0, 0.0, 0.2, 10), 0.01, curved_section);
  set_natural_shape(rods);
  EXPECT_TRUE(rods.natural_curvature_vectors.empty());
  EXPECT_EQ(rods.natural_curvatures.front(), 0.0);
  for (std::uint32_t i = 1; i < 10; ++i) {
    EXPECT_NEAR(rods.natural_curvatures[i], 0.2 / (2.0 * std::sin(0.1)), 1e-12);
  }
  EXPECT_NEAR(bend_energy(rods), 0.0, 1e-24);
}

/// On a clamp, far from their natural shapes, which are curled up to folds. With implicit Euler:
/// such rods turn by many turns in a step, where BDF2 promises nothing.
TEST(NaturalCurvature, RodsGainNoEnergyOnTheWay) {
  SCOPED_TRACE(seed_message());
  Random random(6);
  for (int round = 0; round < rounds(30); ++round) {
    const double length = std::pow(10.0, random.uniform(-2.0, 1.0));
    const double radius = length * std::pow(10.0, random.uniform(-3.0, -1.5));
    const RodMaterial material{std::pow(10.0, random.uniform(5.0, 11.0)),
                               std::pow(10.0, random.uniform(5.0, 11.0)), 1000.0};
    const int nodes = random.integer(2, 40);
    const double edge = length / nodes;
    Rods rods;
    rods.add(random_chain(random, nodes, edge), radius, solid_round_section(material, radius));
    auto twist = std::make_unique<Twist>(rods);
    const double most = random.chance(0.3) ? 3.0 : 2.0;
    for (int node = 0; node < nodes; ++node) {
      rods.natural_curvature_vectors.emplace_back(random.uniform(-most, most) / edge,
                                                  random.uniform(-most, most) / edge);
    }
    displace(rods, random, 0.0, 3.0);
    const Vector3d tangent = random.direction();
    auto held = hold(rods, {clamp(0, {rods.positions[0], tangent, tangent.unitOrthogonal()})});
    Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                          std::make_unique<Gravity>(gravity), std::move(held));
    StepperOptions options;
    options.threads = 1;
    options.max_iterations = random.chance(0.5) ? 20 : 2;
    const double step = std::pow(10.0, random.uniform(-3.0, -1.5));
    begin(all, rods, step);
    EnergyBounds bounds(rods, storing_of(all), options.integrator);
    Stepper stepper(rods, std::move(all), options);
    for (int i = 0; i < 150; ++i) {
      stepper.step(step);
      ASSERT_TRUE(bounds.hold(stepper.rods()))
          << "round " << round << ", step " << i << " of " << step << " s, " << nodes
          << " nodes, length " << length << ", radius " << radius << ", E "
          << material.youngs_modulus << ", G " << material.shear_modulus;
    }
  }
}

TEST(NaturalCurvature, RefusesWhatItCannotUse) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, 4), 0.01, curved_section);
  EXPECT_EQ(error_of([&] { set_natural_arc(rods, 0, 1.0, Vector3d::UnitY()); }),
            "natural curvature: it has no side without twist");
  const Twist twist(rods);
  EXPECT_EQ(error_of([&] { set_natural_arc(rods, 0, -1.0, Vector3d::UnitY()); }),
            "natural curvature: it is -1.000000 1/m, it must be at least 0 and finite");
  const std::string side =
      "natural curvature: the side must be finite and not along the first edge of rod 0";
  for (const Vector3d& towards : {Vector3d(2, 0, 0), Vector3d(0, 0, 0), Vector3d(0, nan, 0)}) {
    EXPECT_EQ(error_of([&] { set_natural_arc(rods, 0, 1.0, towards); }), side);
  }
  EXPECT_TRUE(rods.natural_curvature_vectors.empty());
  set_natural_arc(rods, 0, 1.0, Vector3d::UnitY());
  EXPECT_EQ(error_of([&] { Plasticity(rods, {}); }),
            "plasticity: what stays has no direction, natural curvature must have none, too");
}

}  // namespace
}  // namespace fiber::test
