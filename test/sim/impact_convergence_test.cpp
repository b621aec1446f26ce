// Where a rod is after it has hit a table, as steps get shorter.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "validation/sim/impacts.hpp"

namespace fiber::test {
namespace {

constexpr double time_after = 0.064;
constexpr double fall_height = 0.005;  // from which it flies into the table
constexpr double fall_speed = 2.0;

/// Where the nodes of a rod are some time after it has hit a table.
/// @param tilt how much higher its last end begins, in units of its length
std::vector<Vector3d> after_impact(const char* material, double tilt, Integrator integrator,
                                   double step) {
  const double z = 1.05 * impact_radius + fall_height;
  Rods rods;
  rods.add(straight({0.0, 0.0, z}, {0.0, 0.2, z + 0.2 * tilt}, 10), impact_radius,
           solid_round_section(material_preset(material), impact_radius));
  rods.velocities.assign(rods.positions.size(), -fall_speed * Vector3d::UnitZ());
  StepperOptions options;
  options.integrator = integrator;
  options.residual = 1e-6;  // of thousands of steps
  Stepper stepper(rods, elastic(standard_gravity), options,
                  table_with(0.2, nullptr, Vector3d::Zero()));
  const auto steps = static_cast<int>(std::lround(time_after / step));
  for (int i = 0; i < steps; ++i) {
    stepper.step(step);
  }
  return stepper.rods().positions;
}

/// How high a level rod is then, by Newton's law of impact.
double level_height() {
  const double speed = std::sqrt(fall_speed * fall_speed + 2.0 * standard_gravity * fall_height);
  const double time = time_after - (speed - fall_speed) / standard_gravity;
  return 1.05 * impact_radius + 0.2 * speed * time - 0.5 * standard_gravity * time * time;
}

/// Both integrators come to the same place, by an error in proportion to the step. Of a rod askew,
/// each end and then its middle have impacts of their own while waves run through it.
TEST(ImpactConvergence, PositionsAfterwardsConvergeAsStepsGetShorter) {
  const auto error_of = [](const std::vector<Vector3d>& found, const std::vector<Vector3d>& right) {
    double result = 0.0;
    for (std::size_t i = 0; i < found.size(); ++i) {
      result = std::max(result, (found[i] - right[i]).norm());
    }
    return result;
  };
  for (const auto& [material, tilt] :
       {std::pair{"silicone_tube", 0.0}, {"power_cable", 0.0}, {"silicone_tube", 0.05}}) {
    const std::vector<Vector3d> limit = after_impact(material, tilt, Integrator::BDF2, 2e-6);
    if (tilt == 0.0) {
      for (const Vector3d& node : limit) {
        EXPECT_NEAR(node.z(), level_height(), 1e-5);
      }
    }
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      for (const double step : {256e-6, 64e-6, 16e-6}) {
        SCOPED_TRACE(testing::Message() << material << ", tilt " << tilt << ", integrator "
                                        << static_cast<int>(integrator) << ", " << step << " s");
        constexpr double error_by_step = 8.0;  // [m/s]
        EXPECT_LT(error_of(after_impact(material, tilt, integrator, step), limit),
                  error_by_step * step);
      }
    }
  }
}

}  // namespace
}  // namespace fiber::test
