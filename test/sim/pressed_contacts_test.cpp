// Rods that begin where they touch something: nobody has pressed the barrier together, and it
// throws nobody.

#include <gtest/gtest.h>

#include <algorithm>

#include "validation/sim/impacts.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Rods are put where they touch, or a little deeper than that, which is no overlap yet: the
/// barrier is pressed together by nobody, and gives back nothing.
TEST(PressedContacts, OfTheBeginningThrowNoRod) {
  for (const char* material : {"silicone_tube", "power_cable", "rope", "hair"}) {
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      for (const int substeps : {4, 64}) {
        for (const double share : {1.0, 0.991}) {
          SCOPED_TRACE(testing::Message()
                       << material << ", integrator " << static_cast<int>(integrator) << ", "
                       << substeps << " substeps, at " << share << " radii");
          StepperOptions options;
          options.integrator = integrator;
          const RodSection section = solid_round_section(material_preset(material), impact_radius);
          const double step = 1.0 / (60.0 * substeps);
          Rods rods;
          const double z = share * impact_radius;
          rods.add(straight({0.0, 0.0, z}, {0.0, 0.2, z}, 10), impact_radius, section);
          Stepper on_table(rods, elastic(standard_gravity), options, table_with(0.2, nullptr));
          double highest = 0.0;
          rods.add(straight({0.0, 0.0, 3.0 * z}, {0.0, 0.2, 3.0 * z}, 10), impact_radius, section);
          Stepper two(rods, elastic(), options, contacts_with(nullptr));
          for (int i = 0; i < 12 * substeps; ++i) {
            on_table.step(step);
            two.step(step);
            for (const Vector3d& position : on_table.rods().positions) {
              highest = std::max(highest, position.z());
            }
          }
          EXPECT_LT(highest, 1.15 * impact_radius);
          double fastest = 0.0;
          for (const Vector3d& velocity : two.rods().velocities) {
            fastest = std::max(fastest, velocity.norm());
          }
          EXPECT_LT(fastest, 0.1);
          EXPECT_GT(two.rods().positions.back().z(), 3.0 * z) << "they give way";
        }
      }
    }
  }
}

/// Nor is what an obstacle is put beside while the scene runs.
TEST(PressedContacts, OfAnObstacleThatComesThrowNoRod) {
  Rods rods;
  rods.add(straight({0.0, 0.0, impact_radius}, {0.0, 0.2, impact_radius}, 10), impact_radius,
           solid_round_section(material_preset("power_cable"), impact_radius));
  Stepper stepper(rods, elastic(), StepperOptions{}, contacts_with_moving({}));
  for (int i = 0; i < 10; ++i) {
    stepper.step(1e-3);
  }
  stepper.add_obstacle(going(HalfSpaceShape{}, Vector3d::Zero(), Vector3d::Zero()));
  for (int i = 0; i < 50; ++i) {
    stepper.step(1e-3);
    for (const Vector3d& velocity : stepper.rods().velocities) {
      ASSERT_LT(velocity.norm(), 0.02) << i;
    }
  }
  EXPECT_GT(stepper.rods().positions[5].z(), 1.01 * impact_radius);
}

}  // namespace
}  // namespace fiber::test
