#include "fiber_proximity/sim/effect.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <ostream>
#include <vector>

#include "fiber_proximity/sim/attachment.hpp"
#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"

namespace fiber::test {
namespace {

using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

using EffectPointer = std::unique_ptr<Effect>;

constexpr TimeStep a_step{1.5, 0.02};

/// Makes an effect for rods at rest, and what it needs of them.
struct EffectCase {
  const char* name;
  bool has_twist;
  std::function<EffectPointer(Rods&, Random&)> make;
};

std::ostream& operator<<(std::ostream& out, const EffectCase& effect_case) {
  return out << effect_case.name;
}

EffectPointer make_gravity(Rods& /*rods*/, Random& random) {
  return std::make_unique<Gravity>(random.in_cube(10.0));
}

EffectPointer make_drag(Rods& /*rods*/, Random& random) {
  Drag::Options options;
  options.fluid_density = random.uniform(1.0, 1000.0);
  options.along = random.uniform(0.0, 1.0);
  options.wind = {random.in_cube(10.0), random.in_cube(3.0), 0.7, 2.0};
  return std::make_unique<Drag>(options);
}

EffectPointer make_damping(Rods& /*rods*/, Random& random) {
  return std::make_unique<Damping>(random.uniform(0.01, 0.1));
}

EffectPointer make_curved_bend(Rods& rods, Random& random) {
  rods.natural_curvatures.resize(rods.positions.size());
  for (double& curvature : rods.natural_curvatures) {
    curvature = random.chance(0.2) ? 0.0 : random.uniform(0.0, 3.0);
  }
  return std::make_unique<Bend>();
}

/// Bends to random sides, up to a fold and beyond.
void curve(Rods& rods, Random& random) {
  rods.natural_curvature_vectors.resize(rods.positions.size());
  for (Eigen::Vector2d& curvature : rods.natural_curvature_vectors) {
    curvature = {random.uniform(-8.0, 8.0), random.uniform(-8.0, 8.0)};
  }
}

EffectPointer make_naturally_curved_bend(Rods& rods, Random& random) {
  curve(rods, random);
  return std::make_unique<Bend>();
}

/// With tensions that an earlier step has left.
EffectPointer make_inextensible(Rods& rods, Random& random) {
  auto inextensible = std::make_unique<Inextensible>(rods);
  Rods elsewhere = rods;
  inextensible->begin_step(elsewhere, a_step);
  displace(elsewhere, random, 0.05);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    inextensible->update_multipliers(elsewhere, rod);
  }
  return inextensible;
}

/// Directors that have turned against each other, some by more than a turn.
EffectPointer make_twist(Rods& rods, Random& random) {
  auto twist = std::make_unique<Twist>(rods);
  for (int i = 0; i < 10; ++i) {
    for (std::size_t edge = 0; edge < rods.directors.size(); ++edge) {
      const Eigen::AngleAxisd turn(random.uniform(-1.5, 1.5), rods.start_tangents[edge]);
      rods.directors[edge] = turn * rods.directors[edge];
    }
    twist->end_step(rods, a_step);
  }
  return twist;
}

/// Clamps at both ends of all rods, which lie near to how the ends lie.
EffectPointer make_clamps(Rods& rods, Random& random) {
  auto attachment = std::make_unique<Attachment>();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (const bool is_first : {true, false}) {
      const std::uint32_t node = is_first ? 0 : rods.node_count(rod) - 1;
      const std::uint32_t edge = rods.first(rod) + (is_first ? 0 : node - 1);
      Placement placement;
      placement.position = rods.positions[rods.first(rod) + node];
      placement.tangent = (rods.positions[edge + 1] - rods.positions[edge]).normalized();
      placement.tangent = (placement.tangent + 0.5 * random.in_cube()).normalized();
      placement.director = placement.tangent.unitOrthogonal();
      attachment->add(rods, {rod, node, Attachment::Kind::CLAMP,
                             [placement](double /*time*/) { return placement; }});
    }
  }
  return attachment;
}

/// Some pull with a force that grows with the distance, others with the most they may.
EffectPointer make_pins(Rods& rods, Random& random) {
  auto attachment = std::make_unique<Attachment>();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t node = 0; node < rods.node_count(rod); ++node) {
      const Vector3d position = rods.positions[rods.first(rod) + node] + random.in_cube(0.1);
      attachment->add(rods, {rod, node, Attachment::Kind::PIN,
                             [position](double /*time*/) {
                               return Placement{position, Vector3d::Zero(), Vector3d::Zero()};
                             },
                             std::pow(10.0, random.uniform(3.0, 7.0))});
    }
  }
  return attachment;
}

EffectPointer make_clamps_of_curved(Rods& rods, Random& random) {
  curve(rods, random);
  return make_clamps(rods, random);
}

template <class E>
EffectPointer make(Rods& /*rods*/, Random& /*random*/) {
  return std::make_unique<E>();
}

class EffectTest : public testing::TestWithParam<EffectCase> {
 protected:
  static constexpr double edge_length = 0.3;

  /// Rods at rest with an effect on them.
  void make(Random& random) { make(random, random_rods(random, edge_length)); }

  void make(Random& random, Rods rods) {
    rods_ = std::move(rods);
    twist_ = GetParam().has_twist ? std::make_unique<Twist>(rods_) : nullptr;
    effect_ = GetParam().make(rods_, random);
  }

  /// The middle of a step that deforms the rods.
  void begin_random_step(Random& random) {
    displace(rods_, random, 0.1 * edge_length, 0.5);
    give_velocities(rods_, random, 2.0);
    effect_->begin_step(rods_, a_step);
    displace(rods_, random, 0.1 * edge_length, 0.5);
  }

  Rods rods_;
  EffectPointer twist_;  // only for the frames that it gives the rods
  EffectPointer effect_;
};

TEST_P(EffectTest, HasTheGradientOfItsEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 50; ++round) {
    make(random);
    begin_random_step(random);
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      const VectorXd found = derivatives_of(*effect_, rods_, rod).gradient;
      const VectorXd expected = gradient_by_differences(*effect_, rods_, rod, 1e-6);
      // What differences are wrong by: near a straight rod, much, if it wants to be curved.
      const VectorXd coarse = gradient_by_differences(*effect_, rods_, rod, 2e-6);
      const double error = 1e-9 + 2.0 * (coarse - expected).cwiseAbs().maxCoeff();
      const double scale =
          expected.cwiseAbs().maxCoeff() + std::abs(energy_of(*effect_, rods_, rod));
      ASSERT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-7 * scale + error)
          << "rod " << rod << " of round " << round << "\nfound\n"
          << found.transpose() << "\nexpected\n"
          << expected.transpose();
    }
  }
}

/// The matrix that stands for the Hessian lets the energy rise in no direction faster than it could
/// fall: it is symmetric as it is stored, and positive semidefinite.
TEST_P(EffectTest, HasAPositiveSemidefiniteMatrix) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 50; ++round) {
    make(random);
    begin_random_step(random);
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      const MatrixXd hessian = derivatives_of(*effect_, rods_, rod).hessian;
      const VectorXd eigenvalues = Eigen::SelfAdjointEigenSolver<MatrixXd>(hessian).eigenvalues();
      ASSERT_GE(eigenvalues.minCoeff(), -1e-12 * eigenvalues.maxCoeff() - 1e-300)
          << "rod " << rod << " of round " << round;
    }
  }
}

TEST_P(EffectTest, DoesTheSameToRodsSideBySide) {
  SCOPED_TRACE(seed_message());
  Random random(5);
  for (int round = 0; round < 50 && !HasFailure(); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    make(random, rods_of_equal_sizes(random, random.integer(2, lane_count), random.integer(2, 9),
                                     edge_length));
    begin_random_step(random);
    expect_same_side_by_side(*effect_, rods_);
  }
}

/// Effects whose matrix is the whole Hessian where all edges are stretched.
class ExactEffectTest : public EffectTest {};

TEST_P(ExactEffectTest, HasItsHessian) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (int round = 0; round < 50; ++round) {
    make(random);
    begin_random_step(random);
    for (Vector3d& position : rods_.positions) {
      position *= 3.0;  // all edges are under tension then
    }
    for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
      const MatrixXd found = derivatives_of(*effect_, rods_, rod).hessian;
      const MatrixXd expected = hessian_by_differences(*effect_, rods_, rod, 1e-5);
      ASSERT_LE((found - expected).cwiseAbs().maxCoeff(),
                1e-7 * (1.0 + expected.cwiseAbs().maxCoeff()))
          << "rod " << rod << " of round " << round;
    }
  }
}

/// A rod's energy is that of the same rod elsewhere among others.
TEST_P(EffectTest, ActsOnEachRodAlone) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  make(random);
  begin_random_step(random);
  for (std::uint32_t rod = 0; rod < rods_.count(); ++rod) {
    const double energy = energy_of(*effect_, rods_, rod);
    Rods moved = rods_;
    for (std::uint32_t i = 0; i < moved.positions.size(); ++i) {
      if (i < moved.first(rod) || i >= moved.end(rod)) {
        moved.positions[i] += random.in_cube();
      }
    }
    EXPECT_EQ(energy_of(*effect_, moved, rod), energy);
  }
}

const auto name_of = [](const auto& effect_case) { return std::string(effect_case.param.name); };

const std::vector<EffectCase> exact_cases = {
    {"gravity", false, make_gravity},  {"gravity_beside_twist", true, make_gravity},
    {"stretch", false, make<Stretch>}, {"stretch_beside_twist", true, make<Stretch>},
    {"drag", false, make_drag},        {"drag_beside_twist", true, make_drag},
};
INSTANTIATE_TEST_SUITE_P(Exact, EffectTest, testing::ValuesIn(exact_cases), name_of);
INSTANTIATE_TEST_SUITE_P(Exact, ExactEffectTest, testing::ValuesIn(exact_cases), name_of);

INSTANTIATE_TEST_SUITE_P(
    Approximate, EffectTest,
    testing::Values(EffectCase{"bend", false, make<Bend>},
                    EffectCase{"bend_of_curved_rods", false, make_curved_bend},
                    EffectCase{"bend_beside_twist", true, make<Bend>},
                    EffectCase{"bend_of_curved_rods_beside_twist", true, make_curved_bend},
                    EffectCase{"twist", true, make_twist},
                    EffectCase{"damping", false, make_damping},
                    EffectCase{"damping_beside_twist", true, make_damping},
                    EffectCase{"inextensible", false, make_inextensible},
                    EffectCase{"clamps", false, make_clamps}, EffectCase{"pins", false, make_pins},
                    EffectCase{"bend_to_natural_sides", true, make_naturally_curved_bend},
                    EffectCase{"clamps_of_twisted_rods", true, make_clamps},
                    EffectCase{"clamps_of_curved_rods", true, make_clamps_of_curved}),
    name_of);

}  // namespace
}  // namespace fiber::test
