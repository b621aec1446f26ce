// Rods at rest rise freely where gravity is turned round: a simulation whose contacts lock
// would stay, and look as if it were at rest.

#include "test/sim/reversal.hpp"

#include <cmath>
#include <ostream>
#include <sstream>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "test/sim/extra_scene.hpp"
#include "test/support/random.hpp"
#include "test/support/rounds.hpp"
#include "test/support/source_folder.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double rising = 0.5;  // [s]

/// A scene, how long it takes to settle, and whether things touch in it then.
struct Shipped {
  const char* name;
  double settling;  // [s]
  bool has_fiber_contacts;
  bool has_obstacle_contacts;
};

class ShippedReversal : public testing::TestWithParam<Shipped> {};

/// Settled as shipped, with the most iterations that it has, and then balanced, so that forces are
/// known.
TEST_P(ShippedReversal, RisesFreely) {
  const Shipped& shipped = GetParam();
  const auto file = source_folder() / "config/sim" / (std::string(shipped.name) + ".yaml");
  SimScene scene =
      make_sim_scene(read_sim_scene(load_yaml(file), mesh_files(file.parent_path())), 1);
  while (scene.stepper->time() < shipped.settling) {
    scene.advance();
  }
  Rods rods = scene.stepper->rods();
  std::unique_ptr<Joints> joints;
  if (scene.stepper->joints() != nullptr) {
    joints = joined_again(rods, *scene.stepper->joints());
  }
  Reversal reversal(rods, scene.has_contacts ? contacts_with(scene.environment) : nullptr,
                    StepperOptions{}, std::move(joints));
  reversal.run(rising, scene.step_length());
  EXPECT_TRUE(reversal.has_risen());
  EXPECT_EQ(reversal.fiber_contacts() > 0, shipped.has_fiber_contacts);
  EXPECT_EQ(reversal.obstacle_contacts() > 0, shipped.has_obstacle_contacts);
}

INSTANTIATE_TEST_SUITE_P(
    Scenes, ShippedReversal,
    testing::Values(Shipped{"capstan", 2.0, false, true}, Shipped{"close_cable", 4.5, false, true},
                    Shipped{"demo", 3.0, true, true}, Shipped{"hanging_cable", 2.0, false, false},
                    Shipped{"harness", 3.5, false, true}, Shipped{"hose", 2.0, false, true},
                    Shipped{"joined", 2.0, true, false}, Shipped{"knot", 3.5, true, false},
                    Shipped{"pile", 3.0, true, true}, Shipped{"push_rope", 3.0, false, false},
                    Shipped{"rubber_band", 5.0, false, true}, Shipped{"wind", 2.0, false, false}),
    [](const auto& scene) { return std::string(scene.param.name); });

/// Rods above a table, perhaps with a post that lies on it.
class RandomHeap {
 public:
  explicit RandomHeap(Random& random) : random_(random) {
    const std::vector<std::string> materials = material_names();
    const auto which =
        static_cast<std::size_t>(random.integer(0, static_cast<int>(materials.size()) - 1));
    material_ = materials[which];
    radius_ = random.uniform(0.002, 0.006);
    if (random.chance(0.5)) {
      add_coil();
    }
    const int crossing = random.integer(rods_.count() == 0 ? 2 : 0, 6);
    for (int i = 0; i < crossing; ++i) {
      add_crossing(i);
    }
    make_environment();
    text_ << material_ << ", radius " << radius_ << ", " << rods_.count() << " rods, " << crossing
          << " across";
  }

  /// Lets them fall and settle, with friction.
  Rods settled(const StepperOptions& options, double step) const {
    Effects effects = elastic(standard_gravity);
    effects.push_back(std::make_unique<Damping>(0.01));
    Stepper stepper(rods_, std::move(effects), options, contacts_with(environment_, 0.4));
    while (stepper.time() < 1.0) {
      stepper.step(step);
    }
    return stepper.rods();
  }

  const std::shared_ptr<const Environment>& environment() const { return environment_; }
  std::string description() const { return text_.str(); }

 private:
  /// A helix that piles up.
  void add_coil() {
    const double coil = random_.uniform(0.03, 0.08);
    const double pitch = random_.uniform(3.0, 8.0) * radius_;
    const double turns = random_.uniform(2.0, 4.0);
    const int segments = random_.integer(40, 120);
    std::vector<Vector3d> points;
    for (int i = 0; i <= segments; ++i) {
      const double angle = 2.0 * M_PI * turns * i / segments;
      points.emplace_back(coil * std::cos(angle), coil * std::sin(angle),
                          0.03 + pitch * angle / (2.0 * M_PI));
    }
    top_ = points.back().z();
    rods_.add(points, radius_, section());
  }

  /// One more above all others.
  void add_crossing(int number) {
    top_ += 4.0 * radius_;
    const double turn = number * M_PI / 2.0 + random_.uniform(-0.5, 0.5);
    const Vector3d along =
        random_.uniform(0.08, 0.15) * Vector3d(std::cos(turn), std::sin(turn), 0.0);
    const Vector3d middle(random_.uniform(-0.03, 0.03), random_.uniform(-0.03, 0.03), top_);
    rods_.add(straight(middle - along, middle + along, random_.integer(8, 24)), radius_, section());
  }

  void make_environment() {
    std::vector<EnvironmentObject> objects(1);
    objects[0].name = "table";
    objects[0].shapes.push_back({HalfSpaceShape{}, Eigen::Isometry3d::Identity()});
    if (random_.chance(0.4)) {
      const double post = random_.uniform(0.003, 0.008);
      EnvironmentObject object;
      object.name = "post";
      object.pose = Eigen::Translation3d(0.0, random_.uniform(-0.03, 0.03), post) *
                    Eigen::AngleAxisd(M_PI / 2, Vector3d::UnitY());
      object.shapes.push_back({CylinderShape{post, 0.1}, Eigen::Isometry3d::Identity()});
      objects.push_back(object);
      text_ << "a post, ";
    }
    environment_ = std::make_shared<const Environment>(objects);
  }

  RodSection section() const { return solid_round_section(material_preset(material_), radius_); }

  Random& random_;
  std::string material_;
  double radius_ = 0.0;
  double top_ = 0.03;
  Rods rods_;
  std::shared_ptr<const Environment> environment_;
  std::ostringstream text_;
};

class ExtraReversal : public testing::TestWithParam<Extra> {};

/// With what loads have pressed and bent, on a table that may have moved until then.
TEST_P(ExtraReversal, RisesFreely) {
  constexpr double radius = 0.004;
  constexpr double step = 1.0 / 240.0;
  Rods rods;
  for (int rod = 0; rod < 4; ++rod) {
    const double turn = 0.9 * rod;
    const Vector3d along(0.1 * std::cos(turn), 0.1 * std::sin(turn), 0.0);
    const Vector3d middle(0.0, 0.0, 0.01 + 0.015 * rod);
    rods.add(straight(middle - along, middle + along, 12), radius, rubber(radius));
  }
  const ExtraScene scene(rods, GetParam(), 0.09);
  Effects effects = elastic(standard_gravity);
  effects.push_back(std::make_unique<Damping>(0.01));
  scene.add_effects(effects);
  StepperOptions options;
  options.threads = 1;
  Stepper stepper(scene.rods(), std::move(effects), options, scene.contacts(0.0, 0.4),
                  scene.joints());
  while (stepper.time() < 1.5) {
    stepper.step(step);
  }
  Rods settled = stepper.rods();
  std::unique_ptr<Joints> joints;
  if (stepper.joints() != nullptr) {
    joints = joined_again(settled, *stepper.joints());
  }
  const auto table = environment_of(HalfSpaceShape{}, scene.table_at(stepper.time()));
  Reversal reversal(settled, contacts_with(table), options, std::move(joints));
  reversal.run(rising, step);
  EXPECT_TRUE(reversal.has_risen());
  EXPECT_GT(reversal.fiber_contacts(), 0);
  EXPECT_GT(reversal.obstacle_contacts(), 0);
}

INSTANTIATE_TEST_SUITE_P(Scenes, ExtraReversal,
                         testing::Values(Extra::LOADS, Extra::MOMENT, Extra::SECTIONS, Extra::BALL,
                                         Extra::WELD, Extra::CLOSED, Extra::LIFT, Extra::STRIPS),
                         [](const auto& extra) { return name_of(extra.param); });

/// Settled to the full residual, or in few iterations as shipped scenes have.
TEST(Reversal, RandomHeapsRiseFreely) {
  SCOPED_TRACE(seed_message());
  Random random(1);
  int with_fiber_contacts = 0;
  int with_obstacle_contacts = 0;
  const int heaps = rounds(20);
  for (int round = 0; round < heaps; ++round) {
    const RandomHeap heap(random);
    SCOPED_TRACE("round " + std::to_string(round) + ": " + heap.description());
    StepperOptions options;
    options.threads = 1;
    options.max_iterations = random.chance(0.5) ? options.max_iterations : 4;
    const double step = random.chance(0.5) ? 1.0 / 240.0 : 1.0 / 120.0;
    Reversal reversal(heap.settled(options, step), contacts_with(heap.environment()),
                      StepperOptions{});
    reversal.run(rising, step);
    EXPECT_TRUE(reversal.has_risen()) << options.max_iterations << " iterations, step " << step;
    with_fiber_contacts += reversal.fiber_contacts() > 0 ? 1 : 0;
    with_obstacle_contacts += reversal.obstacle_contacts() > 0 ? 1 : 0;
  }
  expect_enough(with_fiber_contacts, heaps / 3);
  expect_enough(with_obstacle_contacts, heaps / 3);
}

}  // namespace
}  // namespace fiber::test
