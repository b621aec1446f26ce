// A helical spring is a rod with natural curvature: what theory says of its stiffness.

#include <gtest/gtest.h>

#include <cmath>
#include <ostream>

#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

struct Spring {
  double pitch_angle;  ///< of the wire against the plane across the axis [rad]
  double twisting;     ///< GJ/EI
  int turns;
  int segments;   ///< of a turn
  double strain;  ///< by which it is made longer, of the length of its wire
};

std::ostream& operator<<(std::ostream& out, const Spring& spring) {
  return out << spring.turns << " turns of " << spring.segments << " segments, pitch angle "
             << spring.pitch_angle << ", GJ/EI " << spring.twisting << ", strain " << spring.strain;
}

/// Force per way [EI/R³] along the axis of a spring of radius R whose ends do not turn (Love 1927,
/// Chap. XIX, spiral springs). Close-coiled it is the GJ/2πR³n of textbooks.
double exact_stiffness(const Spring& spring) {
  const double cosine = std::cos(spring.pitch_angle);
  const double sine = std::sin(spring.pitch_angle);
  return (spring.twisting * cosine * cosine + sine * sine) * cosine / (2.0 * M_PI * spring.turns);
}

/// The stiffness from the energy of a spring of radius 1 between clamps, one of which is drawn
/// away.
double simulated_stiffness(const Spring& spring) {
  const int segments = spring.turns * spring.segments;
  std::vector<Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = 2.0 * M_PI * i / spring.segments;
    points.emplace_back(std::cos(angle), std::sin(angle), std::tan(spring.pitch_angle) * angle);
  }
  Rods rods;
  rods.add(points, 0.01, {1e6, 1.0, spring.twisting, 1.0, 1e-4});
  auto twist = std::make_unique<Twist>(rods);
  set_natural_shape(rods);
  const auto clamp_at = [&](int node, int edge, const Vector3d& way) {
    const Vector3d tangent = (points[edge + 1] - points[edge]).normalized();
    return clamp(node, {points[node] + way, tangent, rods.directors[edge]});
  };
  const double length = 2.0 * M_PI * spring.turns / std::cos(spring.pitch_angle);
  const double way = spring.strain * length;
  auto held =
      hold(rods, {clamp_at(0, 0, Vector3d::Zero()), clamp_at(segments, segments - 1, {0, 0, way})});
  Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(twist),
                        std::move(held));
  Stepper stepper(rods, std::move(all), precise());
  settle(stepper);
  return 2.0 * stepper.energy() / (way * way);
}

class SpringTest : public testing::TestWithParam<Spring> {};

TEST_P(SpringTest, IsAsStiffAsLoveSays) {
  const double exact = exact_stiffness(GetParam());
  const double found = simulated_stiffness(GetParam());
  EXPECT_NEAR(found, exact, 0.01 * exact);
}

INSTANTIATE_TEST_SUITE_P(Springs, SpringTest,
                         testing::Values(Spring{0.03, 0.77, 5, 60, 1e-4},
                                         Spring{0.03, 0.3, 10, 60, 1e-4},
                                         Spring{0.3, 0.77, 10, 60, 1e-4},
                                         Spring{0.3, 0.3, 10, 60, 1e-4}));

/// Theory is 0.2 % away from what it comes to: the clamps do not give way to the side, either.
TEST(Spring, ItsErrorIsOfSecondOrderInTheSegments) {
  std::vector<double> stiffness;
  for (const int segments : {20, 40, 80}) {
    stiffness.push_back(simulated_stiffness({0.03, 0.77, 5, segments, 1e-4}));
  }
  EXPECT_NEAR((stiffness[0] - stiffness[1]) / (stiffness[1] - stiffness[2]), 4.0, 0.4);
}

}  // namespace
}  // namespace fiber::test
