// Loads at which a rod leaves the shape it was in, bracketed: below it returns from a small
// disturbance, above it goes ever farther.

#include "validation/sim/instability.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <utility>

#include "validation/sim/elastica.hpp"

namespace fiber::test {
namespace {

constexpr double below = 0.98;
constexpr double above = 1.02;

TEST(Instability, AColumnBucklesUnderItsOwnWeight) {
  const double critical = critical_weight_of_column();
  EXPECT_NEAR(critical, 7.837, 6e-4);
  EXPECT_LT(growth_of_column(below * critical), 1.0);
  EXPECT_GT(growth_of_column(above * critical), 10.0);
}

TEST(Instability, ATwistedRodBuckles) {
  const double critical = critical_twist();
  EXPECT_NEAR(critical, 8.987, 6e-4);
  EXPECT_LT(growth_of_twisted(below * critical), 1.0);
  EXPECT_GT(growth_of_twisted(above * critical), 10.0);
}

TEST(Instability, ATwistedRodBucklesBetweenHinges) {
  const double critical = critical_moment_of_hinged();
  EXPECT_LT(growth_of_hinged(below * critical), 1.0);
  EXPECT_GT(growth_of_hinged(above * critical), 10.0);
}

TEST(Instability, ARodBentByNatureLeavesItsPlane) {
  for (const auto& [weight, twisting] :
       {std::pair{20.0, 2.0 / 3.0}, {80.0, 2.0 / 3.0}, {40.0, 1.0}}) {
    SCOPED_TRACE(weight);
    const double critical = critical_natural_curvature(weight, twisting);
    EXPECT_LT(growth_of_curved(weight, twisting, below * critical), 1.0);
    EXPECT_GT(growth_of_curved(weight, twisting, above * critical), 10.0);
  }
}

TEST(Instability, ATwistedRingLeavesItsPlane) {
  const double critical = critical_twist_of_ring();
  EXPECT_NEAR(critical * 180.0 / M_PI, 623.5, 0.1);
  const double height = 1.0 / M_PI;
  const EndOfRing stays = end_of_ring(below * critical);
  EXPECT_NEAR(stays.height, height, 0.01 * height);
  EXPECT_LT(stays.out_of_plane, 2e-3);
  // It folds to a figure of eight, runs through itself, which no contact keeps it from here, and
  // opens on the other side with two turns less.
  const EndOfRing turns = end_of_ring(above * critical);
  EXPECT_NEAR(turns.height, -height, 0.01 * height);
  EXPECT_LT(turns.out_of_plane, 2e-3) << "it lies in its plane again";
}

}  // namespace
}  // namespace fiber::test
