#include "fiber_proximity/sim/effects/inextensible.hpp"

#include <gtest/gtest.h>

#include "sim/rod_scene.hpp"

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

TEST(Inextensible, AHangingRodKeepsItsLengthAndKnowsItsTension) {
  Rods rods;
  rods.add(straight(Vector3d::Zero(), Vector3d(0.0, 0.0, -1.0), 20), 0.005,
           {1.0, 1e-3, 0.0, 0.1, 0.0});
  auto inextensible = std::make_unique<Inextensible>(rods);
  const Inextensible& found = *inextensible;
  Effects all = effects(std::make_unique<Gravity>(Vector3d(0.0, 0.0, -standard_gravity)),
                        std::make_unique<Bend>(), std::move(inextensible));
  all.push_back(hold(rods, {pin(0, Vector3d::Zero())}));
  Stepper stepper(rods, std::move(all), precise());
  for (int i = 0; i < 100; ++i) {
    stepper.step(0.01);
  }
  EXPECT_LT(largest_strain(stepper.rods()), 1e-9);
  double weight_below = 0.0;
  for (std::uint32_t edge = 20; edge-- > 0;) {
    weight_below += standard_gravity * stepper.rods().masses[edge + 1];
    EXPECT_NEAR(found.tension(edge), weight_below, 1e-6 * weight_below);
  }
}

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
