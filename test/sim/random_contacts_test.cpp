// Random subsets of all effects with random parameters, contacts among them, for ten thousand
// steps of few iterations: nothing passes through anything, nothing blows up, and what energy a
// step may have gained is told.

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <sstream>

#include "fiber_proximity/sim/effects.hpp"
#include "test/sim/energy_bounds.hpp"
#include "test/sim/random_rods.hpp"
#include "test/sim/tunnelling.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr int scenes = 40;
constexpr int steps_of_first = 10000;
constexpr int steps_of_others = 250;
constexpr double most_gained = 1.0;  // by steps of one to three iterations, of what there was
constexpr double top = 1.5;          // [m] rods begin below, above a table at 0

/// Rods and effects of which each is there by chance, and what it takes to judge them.
struct Scene {
  Rods rods;
  Effects effects;
  std::unique_ptr<Contacts> contacts;
  StepperOptions options;
  double step = 0.0;
  bool is_windy = false;
  bool is_inextensible = false;
  std::string description;
};

/// Chains in cells of their own, so that none begins in another, thrown at each other.
Rods random_rods_apart(Random& random, double cell) {
  Rods rods;
  const RodMaterial material{std::pow(10.0, random.uniform(5.0, 9.0)),
                             std::pow(10.0, random.uniform(5.0, 9.0)),
                             random.uniform(500.0, 5000.0)};
  const double radius = cell * random.uniform(0.01, 0.04);
  const RodSection section = solid_round_section(material, radius);
  const int count = random.integer(2, 5);
  const double speed = std::pow(10.0, random.uniform(-1.0, 1.0));
  for (int rod = 0; rod < count; ++rod) {
    const int edges = random.integer(1, 14);
    const int layer = rod / 4;
    const Vector3d middle(cell * (rod % 2), cell * (rod / 2 % 2), 0.1 + cell * (0.5 + layer));
    std::vector<Vector3d> points{middle};
    Vector3d direction = random.direction();
    for (int i = 0; i < edges; ++i) {
      points.push_back(points.back() + 0.4 * cell / edges * direction);
      direction = (direction + 0.2 * random.direction()).normalized();
    }
    rods.add(points, radius, section);
    const Vector3d velocity = speed * random.direction();
    for (std::uint32_t i = rods.first(rods.count() - 1); i < rods.positions.size(); ++i) {
      rods.velocities[i] = velocity;
    }
  }
  return rods;
}

class SceneMaker {
 public:
  explicit SceneMaker(Random& random) : random_(random) {}

  Scene make() {
    scene_.rods = random_rods_apart(random_, 0.3);
    add_effects();
    add_contacts();
    scene_.options.max_iterations = static_cast<std::uint32_t>(random_.integer(1, 3));
    scene_.step = std::pow(10.0, random_.uniform(-3.0, -1.7));
    text_ << scene_.rods.count() << " rods, " << scene_.options.max_iterations
          << " iterations, step " << scene_.step;
    scene_.description = text_.str();
    return std::move(scene_);
  }

 private:
  bool chance(const char* name, double probability) {
    const bool is = random_.chance(probability);
    text_ << (is ? name : "") << (is ? " " : "");
    return is;
  }

  void add(std::unique_ptr<Effect> effect) { scene_.effects.push_back(std::move(effect)); }

  template <class Make>
  void maybe(const char* name, const Make& make) {
    if (chance(name, 0.6)) {
      add(make());
    }
  }

  void add_effects() {
    Rods& rods = scene_.rods;
    scene_.is_inextensible = chance("inextensible", 0.3);
    if (scene_.is_inextensible) {
      add(std::make_unique<Inextensible>(rods));
    } else {
      maybe("stretch", [] { return std::make_unique<Stretch>(); });
    }
    maybe("gravity", [] { return std::make_unique<Gravity>(Vector3d(0, 0, -standard_gravity)); });
    maybe("bend", [] { return std::make_unique<Bend>(); });
    maybe("twist", [&] { return std::make_unique<Twist>(rods); });
    maybe("damping",
          [&] { return std::make_unique<Damping>(std::pow(10.0, random_.uniform(-4.0, 0.0))); });
    maybe("plasticity", [&] { return std::make_unique<Plasticity>(rods, Plasticity::Options{}); });
    if (chance("drag", 0.3)) {
      scene_.is_windy = true;
      Drag::Options wind;
      wind.wind.mean = random_.in_cube(5.0);
      add(std::make_unique<Drag>(wind));
    }
    maybe("attachment", [&] {
      const auto node = static_cast<std::uint32_t>(random_.integer(0, 1)) * rods.node_count(0) / 2;
      return hold(rods, {pin(node, rods.positions[node])});
    });
  }

  void add_contacts() {
    std::vector<std::unique_ptr<ContactSource>> sources;
    sources.push_back(std::make_unique<FiberContact>(FiberContact::Options{}));
    if (chance("table", 0.6)) {
      sources.push_back(std::make_unique<EnvironmentContact>(environment_of(HalfSpaceShape{}),
                                                             EnvironmentContact::Options{}));
    }
    std::unique_ptr<Friction> friction;
    if (chance("friction", 0.6)) {
      friction = std::make_unique<Friction>(Friction::Options{random_.uniform(0.0, 1.0), 1e-3});
    }
    scene_.contacts = std::make_unique<Contacts>(std::move(sources), std::move(friction));
  }

  Random& random_;
  Scene scene_;
  std::ostringstream text_;
};

/// The energy of rods that touch nothing yet [J].
double energy_at_start(const Effects& effects, Rods& rods, double step) {
  begin(effects, rods, step);
  double energy = kinetic_energy(rods);
  for (const Effect* effect : storing_of(effects)) {
    energy += energy_of(*effect, rods);
  }
  return energy;
}

/// The kinetic energy of how speeds have changed [J].
double energy_of_change(Rods rods, const Rods& before) {
  for (std::size_t i = 0; i < rods.velocities.size(); ++i) {
    rods.velocities[i] -= before.velocities[i];
  }
  for (std::size_t i = 0; i < rods.spins.size(); ++i) {
    rods.spins[i] -= before.spins[i];
  }
  return kinetic_energy(rods);
}

/// Not to move at all would leave the incremental potential that there was of kinetic and stored
/// energy, and no step ends higher, however few its iterations are. So what is stored after it, and
/// half the square of how speeds have changed, are no more than there was: a step that is cut short
/// may gain energy only by that much. Impacts, which change speeds once more, give back no more
/// than the step has taken.
testing::AssertionResult gains_no_more_than_it_may(const Stepper& stepper, const Rods& before,
                                                   double slack) {
  const double gain = stepper.report().energy_gain;
  double most = kinetic_energy(stepper.rods()) - energy_of_change(stepper.rods(), before) + slack;
  if (stepper.report().impacts > 0) {
    most = std::max(most, slack);
  }
  if (gain <= most) {
    return testing::AssertionSuccess();
  }
  return testing::AssertionFailure() << "gains " << gain << " J, at most were " << most << " J";
}

TEST(RandomContacts, NothingPassesThroughAnythingOrBlowsUp) {
  SCOPED_TRACE(seed_message());
  Random random;
  double moved = 0.0;  // [m] the least of a scene's fastest rods
  for (int round = 0; round < rounds(scenes); ++round) {
    Scene scene = SceneMaker(random).make();
    SCOPED_TRACE("round " + std::to_string(round) + ": " + scene.description);
    double weight = 0.0;  // [N]
    for (const double mass : scene.rods.masses) {
      weight += mass * standard_gravity;
    }
    const double before = energy_at_start(scene.effects, scene.rods, scene.step);
    const std::vector<Vector3d> start = scene.rods.positions;
    // Inextensible edges learn what tension they are to have, and store a little more or less by
    // that.
    const double scale = std::abs(before) + weight * top;
    const double slack = (scene.is_inextensible ? 1.0 : 1e-9) * scale;
    Stepper stepper(std::move(scene.rods), std::move(scene.effects), scene.options,
                    std::move(scene.contacts));
    TunnellingChecker checker(stepper.rods());
    const int steps = round == 0 ? steps_of_first : steps_of_others;
    for (int i = 0; i < steps; ++i) {
      const Rods last = stepper.rods();
      stepper.step(scene.step);
      ASSERT_TRUE(all_finite(stepper.rods())) << "step " << i;
      ASSERT_EQ(checker.check(stepper.rods()), "") << "step " << i;
      if (!scene.is_windy) {
        ASSERT_TRUE(gains_no_more_than_it_may(stepper, last, slack)) << "step " << i;
        ASSERT_LE(stepper.energy(), before + most_gained * (scale + kinetic_energy(stepper.rods())))
            << "step " << i;
      }
    }
    double farthest = 0.0;
    for (std::size_t i = 0; i < start.size(); ++i) {
      farthest = std::max(farthest, (stepper.rods().positions[i] - start[i]).norm());
    }
    moved = round == 0 ? farthest : std::min(moved, farthest);
  }
  EXPECT_GT(moved, 0.01);
}

/// Without resistance to stretch, rods that hit a table shrink to nothing, where no step leads on.
TEST(RandomContacts, StepsThatAreCutShortTellWhatTheyGain) {
  SCOPED_TRACE(seed_message());
  Random random;
  double gained = 0.0;  // the most, of what there was
  for (int round = 0; round < rounds(60); ++round) {
    SCOPED_TRACE("round " + std::to_string(round));
    Rods rods = random_rods_apart(random, 0.3);
    Effects effects = elastic(standard_gravity);
    effects.erase(effects.begin());
    constexpr double step = 0.007;
    const double first = energy_at_start(effects, rods, step);
    const double scale = std::abs(first);
    StepperOptions options;
    options.max_iterations = static_cast<std::uint32_t>(random.integer(1, 3));
    Stepper stepper(rods, std::move(effects), options,
                    contacts_with(environment_of(HalfSpaceShape{}), 0.3));
    double energy = first;
    for (int i = 0; i < 100; ++i) {
      const Rods last = stepper.rods();
      stepper.step(step);
      const StepReport& report = stepper.report();
      ASSERT_NEAR(stepper.energy(), energy + report.energy_gain, 1e-9 * scale) << "step " << i;
      ASSERT_TRUE(gains_no_more_than_it_may(stepper, last, 1e-9 * scale)) << "step " << i;
      ASSERT_LE(stepper.energy(), first + most_gained * scale) << "step " << i;
      gained = std::max(gained, report.energy_gain / scale);
      energy = stepper.energy();
    }
  }
  expect_enough(gained, 1e-3);
}

}  // namespace
}  // namespace fiber::test
