#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "test/sim/energy_bounds.hpp"
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

constexpr double free_fall = 9.81;  // [m/s²]

/// An arc of 1 m that hangs between two points of one height.
/// @param half_angle of the arc [rad]
std::vector<Vector3d> hanging_arc(double half_angle, int segments) {
  const double radius = 0.5 / half_angle;
  std::vector<Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = half_angle * (2.0 * i / segments - 1.0);
    points.emplace_back(radius * std::sin(angle), 0.0,
                        radius * (std::cos(half_angle) - std::cos(angle)));
  }
  return points;
}

Rods arc_of(const std::string& material, int segments) {
  constexpr double radius = 0.004;  // [m]
  Rods rods;
  rods.add(hanging_arc(1.9, segments), radius,
           solid_round_section(material_preset(material), radius));
  return rods;
}

/// Gives rods the velocities of a rotation about an axis through a point [rad/s].
void rotate(Rods& rods, const Vector3d& rate, const Vector3d& point) {
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    rods.velocities[i] = rate.cross(rods.positions[i] - point);
  }
}

/// Kinetic energy, and that of weight, stretch and bend [J].
double energy_under(double weight, const Rods& rods) {
  Rods now = rods;
  Bend bend;
  bend.begin_step(now, {0.0, 1.0});
  double energy = kinetic_energy(rods) + energy_of(Stretch(), rods) + energy_of(bend, rods);
  for (std::size_t i = 0; i < rods.masses.size(); ++i) {
    energy += rods.masses[i] * weight * rods.positions[i].z();
  }
  return energy;
}

Vector3d angular_momentum_about(const Vector3d& point, const Rods& rods) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < rods.masses.size(); ++i) {
    sum += rods.masses[i] * (rods.positions[i] - point).cross(rods.velocities[i]);
  }
  return sum;
}

double angle_at_node(const Rods& rods, std::uint32_t node) {
  const Vector3d a = rods.positions[node] - rods.positions[node - 1];
  const Vector3d b = rods.positions[node + 1] - rods.positions[node];
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

/// The energy that a Kelvin–Voigt material loses by its strain rates in a step of one rod [J].
double lost_by_strain_rates(const Rods& before, const Rods& after, double relaxation_time,
                            double step) {
  const RodSection& section = after.sections.front();
  double lost = 0.0;
  for (std::uint32_t i = 0; i + 1 < after.positions.size(); ++i) {
    const double longer = (after.positions[i + 1] - after.positions[i]).norm() -
                          (before.positions[i + 1] - before.positions[i]).norm();
    lost += section.stretching_stiffness / after.rest_lengths[i] * longer * longer;
    if (i > 0) {
      const double larger = angle_at_node(after, i) - angle_at_node(before, i);
      lost += section.bending_stiffness / after.rest_length_at(i) * larger * larger;
    }
  }
  return relaxation_time / step * lost;
}

/// A step in which the middle of a rod bends, or turns against its ends, by so much.
TEST(Damping, BesideTwistResistsTheRatesOfBendAndTwist) {
  const auto energy_after = [](bool has_twist, double way, double angle) {
    Rods rods;
    rods.add(straight(Vector3d::Zero(), {0.4, 0.0, 0.0}, 4), 0.005, {1.0, 0.3, 0.7, 1.0, 0.1});
    const auto twist = has_twist ? std::make_unique<Twist>(rods) : nullptr;
    if (has_twist) {
      rods.angles = {0.3, 0.3, 0.3, 0.3, 0.0};
    }
    Damping damping(0.02);
    damping.begin_step(rods, {0.0, 0.01});
    rods.positions[2].z() += way;
    if (has_twist) {
      rods.angles[1] += angle;
      rods.angles[2] += angle;
    }
    return energy_of(damping, rods);
  };
  // Two nodes, a length of 0.1 m each.
  EXPECT_NEAR(energy_after(true, 0.0, 1e-3), 0.02 / 0.01 * 0.7 / 0.1 * 1e-6, 1e-12);
  // With twist the strain of a turn by φ vanishes towards a fold: by a part of φ² less than
  // without.
  const double bent = energy_after(false, 1e-3, 0.0);
  EXPECT_NEAR(energy_after(true, 1e-3, 0.0), bent, 1e-5 * bent);
  EXPECT_GT(bent, 1e-4);
}

/// Sees what rates of each solve are measured from.
class EarlierStates : public Effect {
 public:
  void begin_step(Rods& rods, const TimeStep& step) override {
    double weights = 0.0;
    int states = 0;
    Vector3d sum = Vector3d::Zero();
    step.for_each_earlier(rods, [&](const RodState& state, double weight) {
      weights += weight;
      ++states;
      sum += weight * state.positions.front();
    });
    EXPECT_NEAR(weights, 1.0, 1e-15);
    EXPECT_LE((sum - rods.positions.front()).norm(), 1e-15);
    counts.push_back(states);
  }

  std::vector<int> counts;
};

TEST(TimeStep, TellsEffectsTheStatesThatRatesAreMeasuredFrom) {
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    Rods rods = arc_of("rope", 5);
    rotate(rods, Vector3d::UnitX(), Vector3d::Zero());
    const auto seen = std::make_shared<EarlierStates>();
    Stepper stepper(rods, {std::make_shared<Stretch>(), seen}, precise(integrator));
    for (const double step : {0.01, 0.01, 0.02}) {
      stepper.step(step);
    }
    // The first step of BDF2 has two stages, of which the second one has two states.
    EXPECT_EQ(seen->counts, integrator == Integrator::BDF2 ? (std::vector<int>{1, 2, 2, 2})
                                                           : (std::vector<int>{1, 1, 1}));
  }
}

TEST(CosineAndSine, AreThoseOfTheStandardLibrary) {
  for (double angle = -50.0; angle < 50.0; angle += 0.0137) {
    const CosineSine found = cosine_and_sine(angle);
    EXPECT_NEAR(found.cosine, std::cos(angle), 1e-14) << angle;
    EXPECT_NEAR(found.sine, std::sin(angle), 1e-14) << angle;
  }
}

/// Where rods straighten, the matrix of damping alone has negative eigenvalues: with that of bend
/// it has none, and no more than that is taken.
TEST(Damping, BesideBendHasAPositiveSemidefiniteMatrix) {
  SCOPED_TRACE(seed_message());
  Random random(9);
  int negative = 0;
  for (int round = 0; round < 50; ++round) {
    Rods rods = random_rods(random);
    for (RodSection& section : rods.sections) {
      section.stretching_stiffness = 0.0;
    }
    Damping damping(0.1, true);
    damping.begin_step(rods, {0.0, 0.01});
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      rods.positions[i].y() *= 0.2;
    }
    for (std::uint32_t rod = 1; rod < rods.count(); ++rod) {
      const auto smallest = [](const Eigen::MatrixXd& matrix) {
        return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(matrix).eigenvalues().minCoeff();
      };
      const Eigen::MatrixXd alone = derivatives_of(damping, rods, rod).hessian;
      const Eigen::MatrixXd both = alone + derivatives_of(Bend(), rods, rod).hessian;
      ASSERT_GE(smallest(both), -1e-12 * both.norm()) << "round " << round;
      negative += smallest(alone) < -1e-3 * alone.norm() ? 1 : 0;
    }
  }
  EXPECT_GT(negative, 10);
}

/// A cable hangs from two hinges and swings about the line between them.
TEST(Damping, LosesWhatTheStrainRatesOfASwingingCableLose) {
  constexpr double step = 0.001;  // [s]
  for (const double relaxation_time : {0.01, 0.05}) {
    Rods rods = arc_of("power_cable", 30);
    rotate(rods, 3.0 * Vector3d::UnitX(), rods.positions.front());
    const double first = energy_under(free_fall, rods);
    Stepper stepper(
        rods,
        effects(std::make_unique<Gravity>(Vector3d(0, 0, -free_fall)), std::make_unique<Stretch>(),
                std::make_unique<Bend>(), std::make_unique<Damping>(relaxation_time),
                hold(rods, {pin(0, rods.positions.front()), pin(30, rods.positions.back())})),
        StepperOptions{Integrator::BDF2});
    double expected = 0.0;
    for (int i = 0; i < 2000; ++i) {
      const Rods before = stepper.rods();
      stepper.step(step);
      expected += lost_by_strain_rates(before, stepper.rods(), relaxation_time, step);
    }
    const double lost = first - energy_under(free_fall, stepper.rods());
    EXPECT_NEAR(lost, expected, 0.05 * expected) << relaxation_time;
    EXPECT_GT(expected, 0.01) << "which is enough to be told from what BDF2 loses";
  }
}

/// A bent cable at rest in its shape turns about the line between its hinges: nothing is strained,
/// and nothing brakes it.
TEST(Damping, LetsABentCableTurnAboutItsHinges) {
  for (const double relaxation_time : {0.01, 0.05, 0.2}) {
    Rods rods = arc_of("power_cable", 50);
    set_natural_shape(rods);
    rotate(rods, 3.0 * Vector3d::UnitX(), rods.positions.front());
    const double first = angular_momentum_about(Vector3d::Zero(), rods).x();
    Stepper stepper(
        rods,
        effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                std::make_unique<Damping>(relaxation_time),
                hold(rods, {pin(0, rods.positions.front()), pin(50, rods.positions.back())})),
        StepperOptions{Integrator::BDF2});
    for (int i = 0; i < 1920; ++i) {
      stepper.step(1.0 / 960);
    }
    const double last = angular_momentum_about(Vector3d::Zero(), stepper.rods()).x();
    EXPECT_NEAR(last, first, 1e-3 * first) << relaxation_time;
  }
}

Rods free_coil() {
  constexpr double radius = 0.004;  // [m]
  std::vector<Vector3d> points;
  for (int i = 0; i <= 50; ++i) {
    const double angle = 3.0 * M_PI * i / 50;
    points.emplace_back(0.1 * std::cos(angle), 0.1 * std::sin(angle), 0.008 * angle);
  }
  Rods rods;
  rods.add(points, radius, solid_round_section(material_preset("power_cable"), radius));
  set_natural_shape(rods);
  return rods;
}

/// By what steps leave unbalanced: that adds up, more of it in shorter steps.
TEST(Damping, KeepsTheAngularMomentumOfAFreeCoil) {
  for (const double relaxation_time : {0.01, 0.1, 1.0}) {
    for (const double step : {1.0 / 240, 1.0 / 960, 1.0 / 1920}) {
      Rods rods = free_coil();
      Vector3d middle = Vector3d::Zero();
      double mass = 0.0;
      for (std::size_t i = 0; i < rods.masses.size(); ++i) {
        middle += rods.masses[i] * rods.positions[i];
        mass += rods.masses[i];
      }
      middle /= mass;
      rotate(rods, 3.0 * Vector3d(0.3, 1.0, 0.5).normalized(), middle);
      const Vector3d first = angular_momentum_about(middle, rods);
      Stepper stepper(rods,
                      effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                              std::make_unique<Damping>(relaxation_time)),
                      StepperOptions{Integrator::BDF2});
      while (stepper.time() < 2.0) {
        stepper.step(step);
      }
      const Vector3d last = angular_momentum_about(middle, stepper.rods());
      EXPECT_LE((last - first).norm(), 1e-3 * first.norm())
          << relaxation_time << " s, steps of " << step << " s";
    }
  }
}

/// A rope that hangs from one end and begins as an arc swings, and its free end cracks.
TEST(Damping, MakesNoEnergyWhereARopeCracks) {
  for (const Integrator integrator : {Integrator::IMPLICIT_EULER, Integrator::BDF2}) {
    for (const double relaxation_time : {0.0, 0.01, 0.05}) {
      const Rods rods = arc_of("rope", 50);
      StepperOptions options;
      options.integrator = integrator;
      Stepper stepper(rods,
                      effects(std::make_unique<Gravity>(Vector3d(0, 0, -free_fall)),
                              std::make_unique<Stretch>(), std::make_unique<Bend>(),
                              std::make_unique<Damping>(relaxation_time),
                              hold(rods, {pin(0, rods.positions.front())})),
                      options);
      const double first = energy_under(free_fall, rods);
      double strain = 0.0;
      while (stepper.time() < 2.0) {
        stepper.step(1.0 / 240);
        const Rods& now = stepper.rods();
        ASSERT_LE(energy_under(free_fall, now), first + 1e-3 * weight_times_length(rods, 0))
            << relaxation_time;
        for (std::uint32_t i = 0; i < 50; ++i) {
          const double length = (now.positions[i + 1] - now.positions[i]).norm();
          strain = std::max(strain, std::abs(length / now.rest_lengths[i] - 1.0));
        }
      }
      EXPECT_LE(strain, 1e-4) << relaxation_time;
    }
  }
}

/// A coil that wants to be straight springs open.
TEST(Damping, MakesNoEnergyWhereACoilSpringsOpen) {
  constexpr double radius = 0.0006;  // [m]
  std::vector<Vector3d> points;
  for (int i = 0; i <= 37; ++i) {
    const double angle = 2.0 * M_PI * 1.16 * i / 37;
    points.emplace_back(0.0068 * std::cos(angle), 0.0068 * std::sin(angle), 0.00039 * angle);
  }
  Rods rods;
  rods.add(points, radius, solid_round_section(material_preset("power_cable"), radius));
  const double first = energy_under(0.0, rods);
  for (const double relaxation_time : {1e-4, 1e-3, 3e-3}) {
    Stepper stepper(rods,
                    effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                            std::make_unique<Damping>(relaxation_time)),
                    StepperOptions{Integrator::BDF2});
    for (int i = 0; i < 60; ++i) {
      stepper.step(1.0 / 240);
      ASSERT_LE(energy_under(0.0, stepper.rods()), 1.001 * first) << relaxation_time;
    }
  }
}

}  // namespace
}  // namespace fiber::test
