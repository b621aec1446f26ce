#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double standard_gravity = 9.81;  // [m/s²]

double largest_strain(const Rods& rods) {
  double largest = 0.0;
  for (std::uint32_t i = rods.first(0); i + 1 < rods.end(0); ++i) {
    const double length = (rods.positions[i + 1] - rods.positions[i]).norm();
    largest = std::max(largest, std::abs(length / rods.rest_lengths[i] - 1.0));
  }
  return largest;
}

/// A rod of 1 m, in few segments or thousands.
class HangingRod : public testing::TestWithParam<std::uint32_t> {};

TEST_P(HangingRod, KeepsItsLengthAndKnowsItsTension) {
  const std::uint32_t segments = GetParam();
  Rods rods;
  rods.add(straight(Vector3d::Zero(), Vector3d(0.0, 0.0, -1.0), static_cast<int>(segments)), 0.005,
           {1e4, 1e-3, 0.0, 0.1, 0.0});
  Effects all = effects(std::make_unique<Gravity>(Vector3d(0.0, 0.0, -standard_gravity)),
                        std::make_unique<Bend>(), std::make_unique<Inextensible>(rods),
                        hold(rods, {pin(0, Vector3d::Zero())}));
  Stepper stepper(rods, std::move(all));
  for (int i = 0; i < 10; ++i) {
    stepper.step(1.0 / 60.0);
    EXPECT_EQ(stepper.report().unbalanced, 0U);
    EXPECT_LE(largest_strain(stepper.rods()), 1e-6);
    EXPECT_NEAR(stepper.rods().positions.back().z(), -1.0, 2e-6);
  }
  const RodForces forces = stepper.forces();
  double weight_below = 0.0;
  const double weight = 0.1 * standard_gravity;
  for (std::uint32_t edge = segments; edge-- > 0;) {
    weight_below += standard_gravity * stepper.rods().masses[edge + 1];
    ASSERT_NEAR(forces.tensions[edge], weight_below, 1e-3 * weight) << edge;
  }
  ASSERT_EQ(forces.holds.size(), 1U);
  EXPECT_NEAR(forces.holds[0].force.z(), weight, 1e-3 * weight);
}

INSTANTIATE_TEST_SUITE_P(Segments, HangingRod, testing::Values(20, 1000, 3000, 5000),
                         [](const auto& segments) { return std::to_string(segments.param); });

TEST(Inextensible, ASwingingRodKeepsItsLengthWhereASoftOneStretches) {
  Rods rods;
  rods.add(straight(Vector3d::Zero(), Vector3d(1.0, 0.0, 0.0), 20), 0.005,
           {10.0, 1e-3, 0.0, 0.1, 0.0});
  const auto swing = [&rods](std::unique_ptr<Effect> length) {
    Effects all = effects(std::make_unique<Gravity>(Vector3d(0.0, 0.0, -standard_gravity)),
                          std::make_unique<Bend>());
    all.push_back(std::move(length));
    all.push_back(hold(rods, {pin(0, Vector3d::Zero())}));
    Stepper stepper(rods, std::move(all));
    double largest = 0.0;
    for (int i = 0; i < 240; ++i) {
      stepper.step(1.0 / 240.0);
      largest = std::max(largest, largest_strain(stepper.rods()));
    }
    return largest;
  };
  EXPECT_LT(swing(std::make_unique<Inextensible>(rods)), 1e-3);
  EXPECT_GT(swing(std::make_unique<Stretch>()), 0.05);
}

}  // namespace
}  // namespace fiber::test
