// Shares of steps along parabolas and walls.

#include "src/sim/solver/line_search.hpp"

#include <gtest/gtest.h>

#include <functional>

namespace fiber::test {
namespace {

using Energy = std::function<double(double)>;  // by the share

std::vector<EnergySum> energies_at(const LineSearch& search, const std::vector<Energy>& along) {
  std::vector<EnergySum> energies(along.size());
  for (std::size_t i = 0; i < along.size(); ++i) {
    energies[i].add(along[i](search.island(i).share));
  }
  return energies;
}

/// Searches as Newton's method does, side by side.
/// @param decreases that slopes promise
LineSearch searched(const std::vector<Energy>& along, const std::vector<double>& decreases) {
  LineSearch search;
  search.begin(along.size(), LineSearch::max_halvings);
  for (std::size_t i = 0; i < along.size(); ++i) {
    LineSearch::Island& island = search.island(i);
    island.accepted.add(along[i](0.0));
    island.predicted_decrease = decreases[i];
  }
  search.run([&] { return energies_at(search, along); });
  return search;
}

/// With its minimum at a share.
Energy parabola(double minimum) {
  return [minimum](double x) { return 3.0 + (x - minimum) * (x - minimum); };
}

TEST(LineSearch, AStepThatBringsWhatItPromisesIsGone) {
  const LineSearch search = searched({parabola(1.0)}, {2.0});
  EXPECT_EQ(search.island(0).share, 1.0);
  EXPECT_DOUBLE_EQ(search.island(0).expected_share, 1.0);
}

TEST(LineSearch, HowMuchTooShortAStepIsIsKnown) {
  const LineSearch search = searched({parabola(4.0)}, {8.0});
  EXPECT_EQ(search.island(0).share, 1.0);
  EXPECT_DOUBLE_EQ(search.island(0).expected_share, 4.0);
}

/// Nearly as high on the other side.
TEST(LineSearch, AStepAcrossAValleyGoesBackToItsMiddle) {
  const LineSearch search = searched({parabola(0.51), parabola(1.0)}, {1.02, 2.0});
  EXPECT_DOUBLE_EQ(search.island(0).share, 0.51);
  EXPECT_EQ(search.island(1).share, 1.0) << "each by itself";
}

/// The expected minimum of a parabola is higher than the accepted energy.
TEST(LineSearch, WhatWasFoundStaysWhereItIsBetter) {
  const Energy two_valleys = [](double x) {
    return x < 0.7 ? -x + 4.0 * x * x : -0.2 - 2.0 * (x - 0.7);
  };
  const LineSearch search = searched({two_valleys}, {2.0});
  EXPECT_EQ(search.island(0).share, 1.0);
  EXPECT_LT(search.island(0).expected_share, 1.6);
}

TEST(LineSearch, WhereNothingIsLowerNoShareIsFound) {
  const Energy rising = [](double x) { return x; };
  const LineSearch search = searched({rising, parabola(1.0)}, {1.0, 2.0});
  EXPECT_EQ(search.island(0).share, 0.0);
  EXPECT_TRUE(search.island(0).has_failed);
  EXPECT_EQ(search.island(1).share, 1.0);
  EXPECT_FALSE(search.island(1).has_failed);
}

/// Although it is less than the energy itself.
TEST(LineSearch, ARiseIsNotTaken) {
  const LineSearch search = searched({[](double x) { return 3.0 + x; }}, {1.0});
  EXPECT_EQ(search.island(0).share, 0.0);
  EXPECT_TRUE(search.island(0).has_failed);
}

}  // namespace
}  // namespace fiber::test
