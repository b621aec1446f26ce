// The table by which scenes get their segments and steps, against rods of just these.
#include "src/sim/resolution.hpp"

#include <gtest/gtest.h>

#include "test/support/error_of.hpp"
#include "validation/sim/elastica.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

/// Loads that bend a rod of length and bending stiffness 1: at its tip, and along it.
struct Load {
  double tip;
  double spread;
};

const std::vector<Load> loads{{1, 0}, {3, 0}, {10, 0}, {0, 1}, {0, 8}, {0, 20}, {2, 5}};

/// The relative error of how far the tip sinks.
double tip_error(int segments, const Load& load) {
  Rods rods;
  const double mass = load.spread > 0.0 ? load.spread : 1e-9;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, segments), 0.01, {1e7, 1.0, 1.0, mass, 1e-6});
  rods.masses.back() += load.tip;
  auto clamped = hold(rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), Vector3d::UnitY()})});
  Stepper stepper(
      rods,
      effects(std::make_unique<Gravity>(Vector3d(0, 0, -1)), std::make_unique<Stretch>(),
              std::make_unique<Bend>(), std::move(clamped)),
      precise());
  settle(stepper);
  const double exact = cantilever_tip(load.tip, load.spread).drop;
  return std::abs(-stepper.rods().positions.back().z() / exact - 1.0);
}

TEST(Resolution, ErrorsOfSegmentsAreTheTablesAndNoLess) {
  double worst = 0.0;
  for (const Load& load : loads) {
    for (const int segments : {10, 20, 40}) {
      const double constant = tip_error(segments, load) * segments * segments;
      EXPECT_LE(constant, ResolutionTable::bending)
          << segments << " segments, loads " << load.tip << ", " << load.spread;
      worst = std::max(worst, constant);
    }
  }
  RecordProperty("bending", std::to_string(worst));
  EXPECT_GE(worst, 0.5 * ResolutionTable::bending) << "the table promises too little";
}

TEST(Resolution, ChosenSegmentsAreAsAccurateAsAskedFor) {
  for (const double accuracy : {0.1, 0.01, 0.002}) {
    const std::uint32_t segments = segments_for(accuracy, 0.0, 0.0);
    for (const Load& load : loads) {
      EXPECT_LE(tip_error(static_cast<int>(segments), load), accuracy)
          << segments << " segments, loads " << load.tip << ", " << load.spread;
    }
  }
}

TEST(Resolution, CurvesAreAsLongAsAskedFor) {
  constexpr double accuracy = 0.001;
  for (const double turning : {20.0, 40.0}) {
    const double segments = segments_for(accuracy, turning, 0.0);
    // A chord of the angle x of a circle is sin (x / 2) / (x / 2) times as long as its arc.
    const auto error = [turning](double count) {
      return 1.0 - std::sin(0.5 * turning / count) / (0.5 * turning / count);
    };
    EXPECT_LE(error(segments), accuracy);
    EXPECT_GT(error(0.9 * segments), accuracy);
  }
}

/// One edge that swings a little under gravity: in a closed form 0.001 sin ω t.
Stepper swing(Integrator integrator) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {0, 0, -1}, 1), 0.01, {1e9, 0.0, 0.0, 1.0, 0.0});
  rods.velocities[1].x() = 0.001;
  auto pinned = hold(rods, {pin(0, Vector3d::Zero())});
  return Stepper(rods,
                 effects(std::make_unique<Gravity>(Vector3d(0, 0, -1)), std::make_unique<Stretch>(),
                         std::move(pinned)),
                 precise(integrator));
}

constexpr double period = 2.0 * M_PI;  // of this swing [s]

/// The relative loss of the swing's height in a period of so many steps.
double lost_height(std::uint32_t steps) {
  Stepper stepper = swing(Integrator::IMPLICIT_EULER);
  for (std::uint32_t i = 0; i < steps; ++i) {
    stepper.step(period / steps);
  }
  const Rods& rods = stepper.rods();
  return 1.0 - std::hypot(rods.positions[1].x(), rods.velocities[1].x()) / 0.001;
}

/// The relative lag of its angle after a period of so many steps.
double late(std::uint32_t steps) {
  Stepper stepper = swing(Integrator::BDF2);
  for (std::uint32_t i = 0; i < steps; ++i) {
    stepper.step(period / steps);
  }
  const Rods& rods = stepper.rods();
  return std::abs(std::atan2(rods.positions[1].x(), rods.velocities[1].x())) / (2.0 * M_PI);
}

TEST(Resolution, ErrorsOfStepsAreThoseOfTheory) {
  constexpr double euler = 2.0 * M_PI * M_PI;
  constexpr double bdf2 = 4.0 * M_PI * M_PI / 3.0;
  for (const std::uint32_t steps : {1000U, 4000U}) {
    EXPECT_NEAR(lost_height(steps) * steps, euler, 0.02 * euler);
  }
  for (const std::uint32_t steps : {200U, 800U}) {
    EXPECT_NEAR(late(steps) * steps * steps, bdf2, 0.02 * bdf2);
  }
}

TEST(Resolution, ChosenStepsAreAsAccurateAsAskedFor) {
  for (const double accuracy : {0.1, 0.02, 0.005}) {
    // A frame that is a whole period.
    EXPECT_LE(lost_height(substeps_for(accuracy, Integrator::IMPLICIT_EULER, period, period)),
              accuracy);
    EXPECT_LE(late(substeps_for(accuracy, Integrator::BDF2, period, period)), 1.02 * accuracy);
  }
  EXPECT_EQ(substeps_for(0.5, Integrator::IMPLICIT_EULER, 1e-3, 1e9), 1U);
}

constexpr double gravity = 9.81;
constexpr double frame = 1.0 / 60.0;

struct Cable {
  const char* preset;
  double radius;  // [m]
  double length;  // [m]
};

const std::vector<Cable> cables{{"power_cable", 0.004, 1.0},
                                {"silicone_tube", 0.005, 1.0},
                                {"rope", 0.005, 1.0},
                                {"hair", 0.0004, 1.0},
                                {"rope", 0.004, 3.0}};

/// The tip of a cable that is let go at 45° from a pin, after each frame of 0.6 periods.
std::vector<Vector3d> swinging_tip(const RodSection& section, const Cable& cable,
                                   std::uint32_t segments, std::uint32_t substeps,
                                   Integrator integrator) {
  Rods rods;
  const Vector3d end = cable.length * Vector3d(1, 0, -1).normalized();
  rods.add(straight(Vector3d::Zero(), end, static_cast<int>(segments)), cable.radius, section);
  auto pinned = hold(rods, {pin(0, Vector3d::Zero())});
  StepperOptions options;
  options.integrator = integrator;
  options.threads = 1;
  Stepper stepper(rods,
                  effects(std::make_unique<Gravity>(Vector3d(0, 0, -gravity)),
                          std::make_unique<Stretch>(), std::make_unique<Bend>(), std::move(pinned)),
                  options);
  std::vector<Vector3d> tips;
  while (stepper.time() < 0.6 * swing_period(section, cable.length, gravity)) {
    for (std::uint32_t i = 0; i < substeps; ++i) {
      stepper.step(frame / substeps);
    }
    tips.push_back(stepper.rods().positions.back());
  }
  return tips;
}

TEST(Resolution, TheTipOfASwingingCableIsWhereTheAccuracySays) {
  double worst = 0.0;  // in parts of the accuracy
  for (const Cable& cable : cables) {
    const auto& [preset, radius, length] = cable;
    const RodSection section = solid_round_section(material_preset(preset), radius);
    const std::vector<Vector3d> exact =
        swinging_tip(section, cable, length > 1.0 ? 300 : 150, 24, Integrator::BDF2);
    for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
      for (const double accuracy : {0.05, 0.01}) {
        const std::uint32_t substeps =
            substeps_for(accuracy, integrator, frame, swing_period(section, length, gravity));
        const std::vector<Vector3d> tips = swinging_tip(
            section, cable, segments_for(accuracy, 0.0, limpness(section, length, gravity)),
            substeps, integrator);
        double error = 0.0;
        for (std::size_t i = 0; i < exact.size(); ++i) {
          error = std::max(error, (tips[i] - exact[i]).norm());
        }
        error /= length;
        EXPECT_LE(error, accuracy) << preset << " of " << length << " m, integrator "
                                   << static_cast<int>(integrator) << ", " << substeps;
        worst = std::max(worst, error / accuracy);
      }
    }
  }
  RecordProperty("worst", std::to_string(worst));
  EXPECT_GE(worst, 0.5) << "more segments and steps than the accuracy needs";
}

TEST(Resolution, StepsOfContactsAreThoseInWhichLittleFalls) {
  // 10 mm of radius: gravity of 10 m/s² brings a body from rest 1 mm further in 10 ms.
  EXPECT_NEAR(max_contact_step(0.01, 10.0), 0.01, 1e-12);
  EXPECT_EQ(max_contact_step(0.01, 0.0), std::numeric_limits<double>::infinity());
}

TEST(Resolution, SwingsByWeightAndByStiffness) {
  const double infinite = std::numeric_limits<double>::infinity();
  EXPECT_EQ(swing_period({1.0, 0.0, 0.0, 1.0, 0.0}, 1.0, 0.0), infinite);
  // A chain of a metre; a cantilever of 2 m, whose frequency is that of one of 1 m over 4.
  EXPECT_NEAR(swing_period({1.0, 0.0, 0.0, 1.0, 0.0}, 1.0, 9.81), 1.6684, 1e-3);
  EXPECT_NEAR(swing_period({1.0, 1.0, 0.0, 1.0, 0.0}, 2.0, 0.0), 4.0 / 0.5596, 1e-3);
}

TEST(Resolution, RefusesWhatIsNotAllowed) {
  EXPECT_EQ(error_of([] { segments_for(0.0, 1.0, 0.0); }),
            "accuracy is 0.000000, it must be above 0 and at most 0.5");
  EXPECT_EQ(error_of([] { segments_for(0.1, -1.0, 0.0); }),
            "turning is -1.000000 rad, it must be at least 0 and finite");
  EXPECT_EQ(error_of([] { substeps_for(0.1, Integrator::IMPLICIT_EULER, 0.0, 1.0); }),
            "frame is 0.000000 s, it must be positive and finite");
  EXPECT_EQ(error_of([] { substeps_for(0.1, Integrator::IMPLICIT_EULER, 1.0, 0.0); }),
            "period is 0.000000 s, it must be positive");
}

}  // namespace
}  // namespace fiber::test
