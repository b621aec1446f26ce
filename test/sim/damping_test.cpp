#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(Damping, ResistsTheRateOfStretchingWhateverTheStep) {
  constexpr double stiffness = 100.0;        // [N]
  constexpr double relaxation_time = 0.02;   // [s]
  constexpr double rate = 0.1;               // [1/s] of a rod of 1 m
  for (const double step : {0.001, 0.01}) {  // [s]
    Rods rods;
    rods.add(straight(Vector3d::Zero(), Vector3d::UnitX(), 1), 0.005,
             {stiffness, 1e-3, 0.0, 0.001, 0.0});
    const Attachment::Hold drawn{0, 1, Attachment::Kind::PIN, [](double time) {
                                   return Placement{Vector3d(1.0 + rate * time, 0.0, 0.0),
                                                    Vector3d::Zero(), Vector3d::Zero()};
                                 }};
    Stepper stepper(rods, effects(std::make_unique<Damping>(relaxation_time),
                                  hold(rods, {pin(0, Vector3d::Zero()), drawn})));
    for (int i = 0; i < 20; ++i) {
      stepper.step(step);
    }
    const double expected = relaxation_time * stiffness * rate;
    EXPECT_NEAR(stepper.forces().tensions[0], expected, 0.01 * expected) << step;
  }
}

}  // namespace
}  // namespace fiber::test
