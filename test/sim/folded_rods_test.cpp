// Effects of rods that are straight or folded, where formulas have cases of their own.

#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/effect_derivatives.hpp"
#include "test/sim/random_rods.hpp"

namespace fiber::test {
namespace {

using Eigen::MatrixXd;

constexpr TimeStep folded_step{1.5, 0.02};

/// A small bend of a straight rod meets all of the Hessian, to either side.
TEST(Bend, HasItsHessianWhereARodIsStraight) {
  Rods rods;
  rods.add({{0, 0, 0}, {0.3, 0, 0}, {0.5, 0, 0}, {0.9, 0, 0}}, 0.01, {1.0, 0.7, 0.0, 1.0, 0.0});
  const MatrixXd found = derivatives_of(Bend(), rods, 0).hessian;
  const MatrixXd expected = hessian_by_differences(Bend(), rods, 0, 1e-6);
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), 1e-7 * expected.cwiseAbs().maxCoeff());
}

/// Three rods of four nodes: bent, straight, and folded at a node.
Rods bent_straight_and_folded() {
  Rods rods;
  const RodSection section{1.0, 0.7, 0.0, 1.0, 0.0};
  rods.add({{0, 0, 0}, {0.3, 0, 0}, {0.5, 0.1, 0}, {0.9, 0, 0.1}}, 0.01, section);
  rods.add({{0, 0, 0}, {0.2, 0.4, 0.4}, {0.3, 0.6, 0.6}, {0.5, 1.0, 1.0}}, 0.01, section);
  rods.add({{0, 0, 0}, {0, 0, 0.25}, {0, 0, 0}, {0, 0.5, 0}}, 0.01, section);
  return rods;
}

TEST(Bend, OfRodsThatAreStraightIsTheSameSideBySide) {
  Rods rods = bent_straight_and_folded();
  for (const double curvature : {0.0, 2.0}) {
    rods.natural_curvatures.assign(rods.positions.size(), curvature);
    Bend bend;
    bend.begin_step(rods, folded_step);
    expect_same_side_by_side(bend, rods);
  }
}

TEST(Damping, OfRodsThatAreFoldedIsTheSameSideBySide) {
  SCOPED_TRACE(seed_message());
  Random random(6);
  for (const bool is_folded_first : {false, true}) {
    Rods rods = bent_straight_and_folded();
    if (!is_folded_first) {
      displace(rods, random, 0.1);
    }
    Damping damping(0.01);
    damping.begin_step(rods, folded_step);
    if (is_folded_first) {
      displace(rods, random, 0.1);
    } else {
      rods.positions = bent_straight_and_folded().positions;
    }
    expect_same_side_by_side(damping, rods);
  }
}

}  // namespace
}  // namespace fiber::test
