#include "src/sim/contact/barrier.hpp"

#include <gtest/gtest.h>

#include <cmath>

#include "src/sim/contact/edge_contact.hpp"
#include "test/support/not_finite.hpp"
#include "test/support/random.hpp"

namespace fiber::test {
namespace {

Barrier random_barrier(Random& random) {
  return Barrier::around(std::pow(10.0, random.uniform(-5.0, 0.0)),
                         std::pow(10.0, random.uniform(-3.0, 8.0)));
}

/// A distance between the inner and the outer one, often near one of them.
double random_distance(Random& random, const Barrier& barrier) {
  const double part = random.uniform(0.0, 1.0);
  const double power = random.chance(0.5) ? 1.0 : 6.0;
  const double share = random.chance(0.5) ? std::pow(part, power) : 1.0 - std::pow(part, power);
  return barrier.inner + (0.002 + 0.996 * share) * barrier.width();
}

TEST(Barrier, HasTheDerivativesOfItsEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  for (int round = 0; round < 1000; ++round) {
    const Barrier barrier = random_barrier(random);
    const double distance = random_distance(random, barrier);
    const double step = 1e-4 * (distance - barrier.inner);
    const double slope =
        (barrier.energy(distance + step) - barrier.energy(distance - step)) / (2.0 * step);
    const double curvature =
        (barrier.slope(distance + step) - barrier.slope(distance - step)) / (2.0 * step);
    const double force = barrier.scale * barrier.width();
    EXPECT_NEAR(barrier.slope(distance), slope, 1e-6 * (force + std::abs(slope)));
    EXPECT_NEAR(barrier.curvature(distance), curvature, 1e-6 * (barrier.scale + curvature));
    EXPECT_GT(barrier.energy(distance), 0.0);
    EXPECT_LT(barrier.slope(distance), 0.0);
    EXPECT_GT(barrier.curvature(distance), 0.0);
  }
}

TEST(Barrier, IsNoneFromTheOuterDistanceOnAndInfiniteFromTheInnerOneDown) {
  SCOPED_TRACE(seed_message());
  Random random(2);
  for (int round = 0; round < 100; ++round) {
    const double touching = std::pow(10.0, random.uniform(-5.0, 0.0));
    const Barrier barrier = Barrier::around(touching, 100.0);
    EXPECT_NEAR(barrier.inner, 0.95 * touching, 1e-12 * touching);
    EXPECT_NEAR(barrier.outer, 1.05 * touching, 1e-12 * touching);
    for (const double distance : {barrier.outer, 1.1 * touching, 1e3 * touching, infinity}) {
      EXPECT_EQ(barrier.energy(distance), 0.0);
    }
    for (const double distance : {barrier.inner, 0.5 * touching, 0.0, -touching}) {
      EXPECT_EQ(barrier.energy(distance), infinity);
    }
    // It begins without a step in energy, slope or curvature, and ends in no finite force.
    const double before = barrier.outer - 1e-6 * barrier.width();
    EXPECT_LE(barrier.energy(before), 1e-16 * barrier.scale * touching * touching);
    EXPECT_LE(std::abs(barrier.slope(before)), 1e-11 * barrier.scale * touching);
    EXPECT_LE(barrier.curvature(before), 1e-5 * barrier.scale);
    const double force = barrier.scale * barrier.width();
    EXPECT_GE(-barrier.slope(barrier.inner + 1e-9 * barrier.width()), 1e8 * force);
  }
}

TEST(Barrier, HasItsStiffnessWhereSurfacesMeet) {
  const Barrier barrier = Barrier::around(0.02, 1234.0);
  EXPECT_NEAR(barrier.curvature(0.02), 1234.0, 1e-9);
}

TEST(Barrier, WithLessWeightItBeginsNearerAndNeverLetsNearerThanTheLeastDistance) {
  const Barrier barrier = Barrier::around(0.02, 100.0);
  EXPECT_GE(barrier.min_distance(), 0.9 * 0.02);
  EXPECT_EQ(barrier.effective(0.0201, 1.0), 0.0201);
  double last = 0.0201;
  for (const double weight : {0.9, 0.5, 0.1, 0.0}) {
    const double felt = barrier.effective(0.0201, weight);
    EXPECT_GT(felt, last) << weight;
    EXPECT_EQ(barrier.energy(barrier.effective(barrier.outer, weight)), 0.0);
    EXPECT_NEAR(barrier.effective(0.0201 + 1e-6, weight) - felt,
                1e-6 * Barrier::depth_share(weight), 1e-15);
    last = felt;
  }
  EXPECT_NEAR(barrier.effective(barrier.min_distance(), 0.0), barrier.inner, 1e-15);
}

/// The energy of an edge of some weight, by its distance and those of its ends.
WeightedSlopes<2> weighted_slopes(const Barrier& barrier, const Eigen::Vector3d& distances,
                                  double& energy) {
  std::array<Smoothstep, 2> steps{Smoothstep(1.0), Smoothstep(1.0)};
  double weight = 1.0;
  for (int end = 0; end < 2; ++end) {
    steps[end] = Smoothstep((distances[end + 1] - distances[0]) / barrier.width());
    weight *= steps[end].value;
  }
  const WeightedBarrier weighted(barrier, distances[0], weight);
  energy = weighted.energy();
  return weighted.slopes(steps, {1.0, 1.0});
}

TEST(WeightedBarrier, HasTheDerivativesOfItsEnergyByAllDistances) {
  SCOPED_TRACE(seed_message());
  Random random(3);
  for (int round = 0; round < 1000; ++round) {
    const Barrier barrier = random_barrier(random);
    const double width = barrier.width();
    Eigen::Vector3d distances = Eigen::Vector3d::Constant(barrier.inner);
    distances[0] += random.uniform(0.1, 0.95) * width;
    for (int end = 0; end < 2; ++end) {
      distances[end + 1] = distances[0] + random.uniform(0.05, 1.2) * width;
    }
    double energy = 0.0;
    const WeightedSlopes<2> found = weighted_slopes(barrier, distances, energy);
    for (int i = 0; i < 3; ++i) {
      const double step = 1e-6 * width;
      std::array<WeightedSlopes<2>, 2> beside;
      std::array<double, 2> energies{};
      for (int side = 0; side < 2; ++side) {
        Eigen::Vector3d there = distances;
        there[i] += (side == 0 ? -step : step);
        beside[side] = weighted_slopes(barrier, there, energies[side]);
      }
      const double largest = found.gradient.cwiseAbs().maxCoeff();
      EXPECT_NEAR(found.gradient[i], (energies[1] - energies[0]) / (2.0 * step), 1e-5 * largest);
      const Eigen::Vector3d column = (beside[1].gradient - beside[0].gradient) / (2.0 * step);
      EXPECT_LT((found.hessian.col(i) - column).norm(), 1e-4 * found.hessian.norm());
    }
    EXPECT_LT((found.hessian - found.hessian.transpose()).norm(), 1e-12 * found.hessian.norm());
  }
}

/// What is coupled adds up to the positive part: none of it is negative, and nothing positive is
/// missing.
TEST(DistanceTerms, AreCoupledByThePositivePart) {
  SCOPED_TRACE(seed_message());
  Random random(4);
  for (int round = 0; round < 100; ++round) {
    Eigen::Matrix3d square;
    for (int i = 0; i < 3; ++i) {
      square.col(i) = random.in_cube();
    }
    const Eigen::Matrix3d hessian = square + square.transpose();
    const DistanceTerm none{0.0, 0.0, Eigen::Vector3d::UnitZ(), 0.0, 0.0, 0.0};
    DistanceTerms terms;
    terms.push_back(none);
    terms.couple(hessian);
    for (int i = 0; i < 3; ++i) {
      terms.push_back(none);
    }
    Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
    terms.for_each_coupling([&](const DistanceTerms::Parts& parts) {
      const Eigen::Vector3d g(parts[0], parts[1], parts[2]);
      sum += g * g.transpose();
    });
    const Eigen::Vector3d left =
        Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d>(sum - hessian).eigenvalues();
    EXPECT_GT(left.minCoeff(), -1e-12) << "nothing positive is missing";
    EXPECT_LT((sum * (sum - hessian)).norm(), 1e-12) << "and nothing is added to it";
    EXPECT_FALSE(terms.is_coupled(*terms.begin()));
    EXPECT_TRUE(terms.is_coupled(*(terms.begin() + 1)));
    EXPECT_TRUE(terms.is_coupled(*(terms.begin() + 3)));
  }
}

TEST(Barrier, AHeavyLoadLeavesRoomToSolveIn) {
  const Barrier barrier = Barrier::around(0.02, 100.0);
  const double touching = -barrier.slope(0.02);
  double distance = 0.02;
  while (-barrier.slope(distance) < 1000.0 * touching) {
    distance -= 1e-4 * barrier.width();
  }
  EXPECT_GT(distance - barrier.inner, barrier.width() / 9.0);
}

TEST(Barrier, WhatBeginsNearerThanTheInnerDistanceMayStayOrPart) {
  const Barrier barrier = Barrier::around(0.02, 100.0);
  for (const double distance :
       {barrier.inner, 0.0186, barrier.min_distance(), 0.018, 0.001, 1e-9, 0.0, -0.001, -1.0}) {
    const Barrier moved = barrier.relaxed_to(distance);
    EXPECT_LT(moved.inner, barrier.inner);
    EXPECT_EQ(moved.outer, barrier.outer);
    for (const double weight : {0.001, 0.5, 1.0}) {
      const double felt = moved.effective(distance, weight);
      EXPECT_TRUE(std::isfinite(moved.energy(felt))) << distance << ", weight " << weight;
      EXPECT_LT(moved.slope(felt), 0.0) << distance << ", weight " << weight;
      EXPECT_TRUE(std::isfinite(moved.curvature(felt))) << distance << ", weight " << weight;
    }
    // A little farther away, a little less.
    const double farther = barrier.relaxed_to(distance + 1e-9).inner;
    EXPECT_NEAR(farther, moved.inner, 2e-9);
  }
}

TEST(ContactStiffness, HoldsAThousandthOfWhatWouldDoubleTheRod) {
  const RodSection section = solid_round_section({1e9, 4e8, 1000.0}, 0.005);
  for (const double touching : {0.005, 0.01}) {
    const double stiffness = material_contact_stiffness(section, touching);
    const double force = -Barrier::around(touching, stiffness).slope(touching);
    EXPECT_NEAR(force, 1e-3 * section.stretching_stiffness, 1e-12 * section.stretching_stiffness);
  }
}

}  // namespace
}  // namespace fiber::test
