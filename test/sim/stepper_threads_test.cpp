#include <gtest/gtest.h>
#include <tbb/global_control.h>

#include "fiber_proximity/sim/effects.hpp"
#include "src/query/threads.hpp"
#include "test/sim/random_rods.hpp"
#include "test/support/error_of.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// All effects at once, or all but twist, on some dozens of rods, each held at one end.
Rods after_some_steps(Rods rods, bool has_twist, Integrator integrator, std::uint32_t threads) {
  auto twist = has_twist ? std::make_unique<Twist>(rods) : nullptr;
  auto held = std::make_unique<Attachment>();
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    Attachment::Hold pinned = pin(0, rods.positions[rods.first(rod)]);
    pinned.rod = rod;
    held->add(rods, pinned);
  }
  Drag::Options wind;
  wind.wind.mean = {5.0, 1.0, 0.0};
  wind.wind.gust = {2.0, 0.0, 1.0};
  StepperOptions options;
  options.integrator = integrator;
  options.threads = threads;
  Effects all =
      effects(std::make_unique<Gravity>(Vector3d(0, 0, -9.81)), std::make_unique<Stretch>(),
              std::make_unique<Bend>(), std::make_unique<Damping>(0.01),
              std::make_unique<Drag>(wind), std::move(held));
  if (has_twist) {
    all.push_back(std::move(twist));
  }
  Stepper stepper(rods, std::move(all), options);
  for (int i = 0; i < 100; ++i) {
    stepper.step(0.01);
  }
  return stepper.rods();
}

TEST(StepperThreads, GiveTheSameBits) {
  SCOPED_TRACE(seed_message());
  Random random;
  Rods rods;
  constexpr int count = rounds_less > 1 ? 8 : 30;  // still several for each thread
  for (int rod = 0; rod < count; ++rod) {
    rods.add(random_chain(random, random.integer(2, 20), 0.1), 0.01, random_section(random));
  }
  const tbb::global_control more_than_cores(tbb::global_control::max_allowed_parallelism, 4);
  for (const bool has_twist : {true, false}) {
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      const Rods once = after_some_steps(rods, has_twist, integrator, 1);
      for (const std::uint32_t threads : {1U, 2U, 4U, 0U}) {
        const Rods again = after_some_steps(rods, has_twist, integrator, threads);
        EXPECT_EQ(again.positions, once.positions) << threads << " threads";
        EXPECT_EQ(again.velocities, once.velocities) << threads << " threads";
        EXPECT_EQ(again.angles, once.angles) << threads << " threads";
      }
    }
  }
}

TEST(StepperThreads, BeyondTheMostAreRefused) {
  StepperOptions options;
  options.threads = max_threads + 1;
  EXPECT_EQ(error_of([&] { Stepper(Rods(), {}, options); }),
            "threads is 1025, it must be at most 1024 (0 for as many as there are cores)");
}

}  // namespace
}  // namespace fiber::test
