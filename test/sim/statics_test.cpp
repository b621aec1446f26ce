// Shapes at rest against the theory of rods; the quoted digits are those that textbooks print.

#include "validation/sim/statics.hpp"

#include <gtest/gtest.h>

#include <ostream>

#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double percent = 0.01;

struct QuotedTip {
  double load;
  double drop;
  double reach;
};

std::ostream& operator<<(std::ostream& out, const QuotedTip& quoted) {
  return out << "load " << quoted.load;
}

class CantileverTest : public testing::TestWithParam<QuotedTip> {};

TEST_P(CantileverTest, BendsUnderATipLoadAsBisshoppAndDruckerSay) {
  const QuotedTip& quoted = GetParam();
  const CantileverTip exact = cantilever_tip(quoted.load, 0.0);
  EXPECT_NEAR(exact.drop, quoted.drop, 6e-6);
  EXPECT_NEAR(exact.reach, quoted.reach, 6e-6);
  const CantileverTip tip = simulated_tip(50, quoted.load, 0.0);
  EXPECT_NEAR(tip.drop, exact.drop, percent * exact.drop);
  EXPECT_NEAR(tip.reach, exact.reach, percent * exact.reach);
}

INSTANTIATE_TEST_SUITE_P(
    Loads, CantileverTest,
    testing::Values(QuotedTip{0.25, 0.08275, 0.99588}, QuotedTip{1.0, 0.30172, 0.94357},
                    QuotedTip{2.0, 0.49346, 0.83936}, QuotedTip{3.0, 0.60325, 0.74558},
                    QuotedTip{5.0, 0.71379, 0.61237}, QuotedTip{10.0, 0.81061, 0.44500}));

TEST(Statics, ARodBendsUnderItsOwnWeight) {
  const std::vector<std::pair<double, double>> quoted = {{1.0, 0.12347},  {2.0, 0.23851},
                                                         {4.0, 0.42516},  {8.0, 0.64063},
                                                         {10.0, 0.70020}, {20.0, 0.82988}};
  for (const auto& [weight, drop] : quoted) {
    SCOPED_TRACE(weight);
    const double exact = cantilever_tip(0.0, weight).drop;
    EXPECT_NEAR(exact, drop, 6e-6);
    EXPECT_NEAR(simulated_tip(50, 0.0, weight).drop, exact, percent * exact);
  }
}

/// The clamp is half an edge away from where two fixed nodes would have it: the order would be one.
TEST(Statics, TheErrorIsOfSecondOrderInTheSegments) {
  const double exact = cantilever_tip(3.0, 0.0).drop;
  double coarse = std::abs(simulated_tip(10, 3.0, 0.0).drop - exact);
  for (const int segments : {20, 40, 80}) {
    const double fine = std::abs(simulated_tip(segments, 3.0, 0.0).drop - exact);
    EXPECT_NEAR(coarse / fine, 4.0, 0.4) << segments << " segments, error " << fine;
    coarse = fine;
  }
}

TEST(Statics, AChainHangsInACatenary) {
  struct Quoted {
    double length;
    HangingChain chain;
  };
  // Zero where no digits are quoted.
  for (const Quoted& quoted : {Quoted{1.01, {0.06145, 2.0443}}, Quoted{1.05, {0.13930, 0.0}},
                               Quoted{1.1, {0.20030, 0.65496}}, Quoted{1.2, {0.29234, 0.46954}},
                               Quoted{1.5, {0.50263, 0.30824}}, Quoted{2.0, {0.79639, 0.0}}}) {
    SCOPED_TRACE(quoted.length);
    const HangingChain exact = exact_catenary(quoted.length);
    EXPECT_NEAR(exact.sag, quoted.chain.sag, 6e-6);
    if (quoted.chain.pull > 0.0) {
      EXPECT_NEAR(exact.pull, quoted.chain.pull, 6e-5);
    }
    const HangingChain chain = simulated_catenary(quoted.length, 50);
    EXPECT_NEAR(chain.sag, exact.sag, percent * exact.sag);
    EXPECT_NEAR(chain.pull, exact.pull, percent * exact.pull);
  }
}

/// A rod whose natural curvature is that of a circle closes to one, if nothing holds it: even a
/// straight one, which may turn to any side.
TEST(Statics, ARodTakesItsNaturalCurvature) {
  constexpr int segments = 50;
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e4, 1.0, 1.0, 1.0, 1e-6});
  rods.natural_curvatures.assign(rods.positions.size(), 2.0 * M_PI);
  Stepper stepper(rods, effects(std::make_unique<Stretch>(), std::make_unique<Bend>()), precise());
  settle(stepper);
  const std::vector<Vector3d>& positions = stepper.rods().positions;
  EXPECT_LT((positions.back() - positions.front()).norm(), 1e-6);
  EXPECT_NEAR((positions[segments / 2] - positions.front()).norm(), 1.0 / M_PI, 0.01 / M_PI);
}

}  // namespace
}  // namespace fiber::test
