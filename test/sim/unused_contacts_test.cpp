// Contact effects of a scene in which nothing touches change no bit of it.

#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Rods of different sizes beside each other, high above a table.
Rods hanging_rods() {
  Rods rods;
  for (int rod = 0; rod < 6; ++rod) {
    const Vector3d start(0.0, 0.5 * rod, 2.0);
    rods.add(straight(start, start + Vector3d(0.3 + 0.05 * rod, 0.0, 0.1), 8 + rod), 0.004,
             rubber(0.004));
  }
  return rods;
}

Effects effects_of(Rods& rods, bool is_inextensible, bool has_twist) {
  Effects all = elastic(standard_gravity);
  if (is_inextensible) {
    all[0] = std::make_unique<Inextensible>(rods);
  }
  if (has_twist) {
    all.push_back(std::make_unique<Twist>(rods));
  }
  all.push_back(std::make_unique<Damping>(0.01));
  Drag::Options wind;
  wind.wind.mean = {1.0, 0.0, 0.5};
  all.push_back(std::make_unique<Drag>(wind));
  auto held = std::make_unique<Attachment>();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    Attachment::Hold pinned = pin(0, rods.positions[rods.first(rod)]);
    pinned.rod = rod;
    held->add(rods, pinned);
  }
  all.push_back(std::move(held));
  return all;
}

TEST(UnusedContacts, ChangeNoBit) {
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    for (const bool is_inextensible : {false, true}) {
      for (const bool has_twist : {false, true}) {
        StepperOptions options;
        options.integrator = integrator;
        Rods rods = hanging_rods();
        Rods same = rods;
        Effects of_rods = effects_of(rods, is_inextensible, has_twist);
        Effects of_same = effects_of(same, is_inextensible, has_twist);
        Stepper without(rods, std::move(of_rods), options);
        Stepper with(same, std::move(of_same), options,
                     contacts_with(environment_of(HalfSpaceShape{}), 0.3));
        for (int i = 0; i < 120; ++i) {
          without.step(1.0 / 240.0);
          with.step(1.0 / 240.0);
          ASSERT_EQ(with.rods().positions, without.rods().positions) << "step " << i;
          ASSERT_EQ(with.rods().velocities, without.rods().velocities) << "step " << i;
          ASSERT_EQ(with.rods().angles, without.rods().angles) << "step " << i;
        }
        EXPECT_LT(with.rods().positions[8].z(), 2.05) << "they have moved";
        EXPECT_EQ(with.report().coupled_rods, 0U);
      }
    }
  }
}

}  // namespace
}  // namespace fiber::test
