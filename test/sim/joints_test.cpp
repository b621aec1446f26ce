// Joined and closed rods: what is joined moves as one, and forces and moments go through.

#include "fiber_proximity/sim/joints.hpp"

#include <gtest/gtest.h>

#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "src/sim/joint/joint_parts.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double gravity = 9.81;

RodSection section_of(double bending, double twisting = 1e-3) {
  return {2000.0, bending, twisting, 0.05, 1e-6};
}

/// What a scene of joined rods calls for.
struct Scene {
  bool has_twist = false;
  bool is_inextensible = false;
  double relaxation_time = 0.0;
  Integrator integrator = Integrator::IMPLICIT_EULER;
};

std::vector<Scene> scenes() {
  return {{false, false, 0.0, Integrator::IMPLICIT_EULER},
          {true, false, 0.0, Integrator::IMPLICIT_EULER},
          {false, true, 0.01, Integrator::BDF2},
          {true, false, 0.01, Integrator::BDF2}};
}

Effects effects_of(Rods& rods, const Scene& scene) {
  Effects all =
      effects(std::make_unique<Bend>(), std::make_unique<Gravity>(Vector3d(0.0, 0.0, -gravity)));
  if (scene.is_inextensible) {
    all.push_back(std::make_shared<Inextensible>(rods));
  } else {
    all.push_back(std::make_shared<Stretch>());
  }
  if (scene.has_twist) {
    all.push_back(std::make_shared<Twist>(rods));
  }
  if (scene.relaxation_time > 0.0) {
    all.push_back(std::make_shared<Damping>(scene.relaxation_time, !scene.has_twist));
  }
  return all;
}

std::unique_ptr<Joints> joints_of(const Scene& scene) {
  return std::make_unique<Joints>(Joints::Options{true, scene.relaxation_time});
}

/// Points of a fibre that is bent, and moves.
std::vector<Vector3d> bent(int segments) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    const double s = static_cast<double>(i) / segments;
    points.emplace_back(s, 0.1 * std::sin(3.0 * s), 0.15 * s * s);
  }
  return points;
}

Vector3d velocity_at(const Vector3d& point) {
  return {0.3 * point.y(), 0.5 * point.x() - 0.2, std::cos(4.0 * point.x())};
}

void throw_rods(Rods& rods) {
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    rods.velocities[i] = velocity_at(rods.positions[i]);
    if (!rods.spins.empty()) {
      rods.spins[i] = 3.0 * rods.positions[i].x();
    }
  }
}

StepperOptions options_of(const Scene& scene) {
  StepperOptions options = precise(scene.integrator);
  options.residual = scene.is_inextensible ? 1e-8 : options.residual;
  return options;
}

/// [m] Edges that keep their lengths to 1e-6 lead a rod astray by the root of that.
double allowed_difference(const Scene& scene) { return scene.is_inextensible ? 2e-3 : 1e-7; }

/// A hold of a node where it is.
Attachment::Hold pin_of(const Rods& rods, std::uint32_t rod, std::uint32_t node) {
  Attachment::Hold held = pin(node, rods.positions[rods.first(rod) + node]);
  held.rod = rod;
  return held;
}

TEST(Joints, RodCutAndWeldedMovesAsTheWholeOne) {
  constexpr int segments = 14;
  constexpr int cut = 5;
  for (const Scene& scene : scenes()) {
    SCOPED_TRACE(testing::Message() << scene.has_twist << scene.is_inextensible);
    const std::vector<Vector3d> points = bent(segments);
    const auto moved = [&](bool is_cut) {
      Rods rods;
      if (is_cut) {
        rods.add({points.begin(), points.begin() + cut + 1}, 0.004, section_of(0.01));
        rods.add({points.begin() + cut, points.end()}, 0.004, section_of(0.01));
      } else {
        rods.add(points, 0.004, section_of(0.01));
      }
      Effects all = effects_of(rods, scene);
      set_natural_shape(rods);
      std::unique_ptr<Joints> joints;
      if (is_cut) {
        joints = joints_of(scene);
        joints->add(rods, {Joints::Kind::WELD, {{1, 0}, {0, cut}}});
      }
      throw_rods(rods);
      auto held = std::make_shared<Attachment>();
      held->add(rods, pin_of(rods, 0, 0));
      all.push_back(held);
      Stepper stepper(rods, std::move(all), options_of(scene), nullptr, std::move(joints));
      for (int i = 0; i < 100; ++i) {
        stepper.step(0.004);
      }
      Rods end = stepper.rods();
      if (is_cut) {
        EXPECT_EQ(end.positions[cut], end.positions[cut + 1]);
        end.positions.erase(end.positions.begin() + cut);
      }
      return end.positions;
    };
    const std::vector<Vector3d> whole = moved(false);
    const std::vector<Vector3d> welded = moved(true);
    ASSERT_GT((whole.back() - points.back()).norm(), 0.2);
    for (std::size_t i = 0; i < whole.size(); ++i) {
      EXPECT_LE((whole[i] - welded[i]).norm(), allowed_difference(scene)) << i;
    }
  }
}

/// A rod in a circle in the plane of x and z, whose first node is at an index of its polygon.
std::vector<Vector3d> circle(double radius, int segments, int seam) {
  std::vector<Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    const double angle = 2.0 * M_PI * ((i + seam) % segments) / segments;
    points.emplace_back(radius * std::sin(angle), 0.02 * std::cos(2.0 * angle),
                        radius * std::cos(angle));
  }
  return points;
}

/// Makes a rod of circle() stiff and heavy from its third to its tenth edge, wherever its seam is.
void stiffen(Rods& rods, int segments, int seam) {
  std::vector<RodSectionPart> parts;
  const RodSection own = rods.sections[0];
  const RodSection stiff{own.stretching_stiffness, 5.0 * own.bending_stiffness,
                         3.0 * own.twisting_stiffness, 2.0 * own.mass_per_length,
                         own.inertia_per_length};
  double begin = 0.0;
  for (int i = 0; i < segments; ++i) {
    const double end = begin + rods.rest_lengths[static_cast<std::size_t>(i)];
    const int edge = (i + seam) % segments;
    if (edge >= 2 && edge < 10) {
      parts.push_back({{begin, i + 1 == segments ? end - 1e-12 : end}, stiff});
    }
    begin = end;
  }
  rods.set_sections(0, parts);
}

TEST(Joints, PlaceOfTheSeamDoesNotMatter) {
  constexpr int segments = 24;
  enum class Kind { STRAIGHT, NATURAL, SECTIONS };
  for (const Kind kind : {Kind::STRAIGHT, Kind::NATURAL, Kind::SECTIONS}) {
    const bool is_natural = kind == Kind::NATURAL;
    for (const Scene& scene : scenes()) {
      SCOPED_TRACE(testing::Message()
                   << scene.has_twist << scene.is_inextensible << static_cast<int>(kind));
      const auto moved = [&](int seam) {
        Rods rods;
        rods.add(circle(0.2, segments, seam), 0.004, section_of(0.002));
        if (kind == Kind::SECTIONS) {
          stiffen(rods, segments, seam);
        }
        Effects all = effects_of(rods, scene);
        auto joints = joints_of(scene);
        joints->close(rods, 0);
        if (is_natural) {
          set_natural_shape(rods);
        }
        for (std::size_t i = 0; i < rods.positions.size(); ++i) {
          rods.velocities[i] = velocity_at(rods.positions[i]);
        }
        auto held = std::make_shared<Attachment>();
        held->add(rods, pin_of(rods, 0, static_cast<std::uint32_t>((segments - seam) % segments)));
        all.push_back(held);
        StepperOptions options = options_of(scene);
        options.max_iterations = kind == Kind::SECTIONS ? 100 : options.max_iterations;
        Stepper stepper(rods, std::move(all), options, nullptr, std::move(joints));
        for (int i = 0; i < 60; ++i) {
          stepper.step(0.004);
        }
        std::vector<Vector3d> found(segments);
        for (int i = 0; i < segments; ++i) {
          found[static_cast<std::size_t>((i + seam) % segments)] =
              stepper.rods().positions[static_cast<std::size_t>(i)];
        }
        EXPECT_EQ(stepper.rods().positions.front(), stepper.rods().positions.back());
        return found;
      };
      const std::vector<Vector3d> first = moved(0);
      ASSERT_GT((first[12] - circle(0.2, segments, 0)[12]).norm(), 0.02);
      for (const int seam : {7, 12}) {
        const std::vector<Vector3d> other = moved(seam);
        for (std::size_t i = 0; i < first.size(); ++i) {
          EXPECT_LE((first[i] - other[i]).norm(), allowed_difference(scene)) << seam << " " << i;
        }
      }
    }
  }
}

/// Two bars from supports to a point below, and a rod that hangs there as a load.
TEST(Joints, ForcesInATruss) {
  Rods rods;
  const Vector3d point(0.0, 0.0, -0.5);
  const RodSection light{1e6, 1e-3, 1e-3, 1e-6, 1e-9};
  const RodSection heavy{1e6, 1e-3, 1e-3, 10.0, 1e-6};
  rods.add(straight({-1.0, 0.0, 0.0}, point, 1), 0.004, light);
  rods.add(straight(point, {0.25, 0.0, 0.0}, 1), 0.004, light);
  rods.add(straight(point, {0.0, 0.0, -0.7}, 4), 0.004, heavy);
  auto joints = joints_of({});
  joints->add(rods, {Joints::Kind::BALL, {{0, 1}, {1, 0}, {2, 0}}});
  Effects all = effects_of(rods, {});
  auto held = std::make_shared<Attachment>();
  held->add(rods, pin_of(rods, 0, 0));
  held->add(rods, pin_of(rods, 1, 1));
  all.push_back(held);
  Stepper stepper(rods, std::move(all), precise(), nullptr, std::move(joints));
  settle(stepper);
  const RodForces forces = stepper.forces();
  ASSERT_EQ(forces.joints.size(), 3U);
  const double weight = 10.0 * 0.2 * gravity;
  const Vector3d place = stepper.rods().positions[1];
  const Vector3d left = (Vector3d(-1.0, 0.0, 0.0) - place).normalized();
  const Vector3d right = (Vector3d(0.25, 0.0, 0.0) - place).normalized();
  Eigen::Matrix2d balance;
  balance << left.x(), right.x(), left.z(), right.z();
  const Eigen::Vector2d tensions = balance.inverse() * Eigen::Vector2d(0.0, weight);
  EXPECT_NEAR((forces.joints[0].force + tensions[0] * left).norm(), 0.0, 1e-3 * tensions[0]);
  EXPECT_NEAR((forces.joints[1].force + tensions[1] * right).norm(), 0.0, 1e-3 * tensions[1]);
  EXPECT_NEAR((forces.joints[2].force - Vector3d(0.0, 0.0, weight)).norm(), 0.0, 1e-3 * weight);
  EXPECT_LE((forces.joints[0].force + forces.joints[1].force + forces.joints[2].force).norm(),
            1e-6 * weight);
  EXPECT_EQ(forces.joints[2].node, 0U);
  EXPECT_EQ(forces.joints[1].joint, 0U);
}

/// Three branches of different lengths and weights from one point: Y.
Rods branches(double scale = 1.0) {
  Rods rods;
  rods.add(straight({0.0, 0.0, 0.0}, {0.0, 0.0, 0.5 * scale}, 6), 0.004, section_of(0.02));
  rods.add(straight({0.3 * scale, 0.1, -0.2}, {0.0, 0.0, 0.0}, 5), 0.004, section_of(0.01));
  rods.add(straight({0.0, 0.0, 0.0}, {-0.2 * scale, 0.0, -0.4}, 8), 0.003, section_of(0.005));
  return rods;
}

Joints::Joint branching(Joints::Kind kind) { return {kind, {{0, 0}, {1, 5}, {2, 0}}}; }

TEST(Joints, ForcesOfBranchesBalance) {
  for (const Joints::Kind kind : {Joints::Kind::BALL, Joints::Kind::WELD}) {
    for (const bool has_twist : {false, true}) {
      Rods rods = branches();
      Scene scene;
      scene.has_twist = has_twist;
      Effects all = effects_of(rods, scene);
      auto joints = joints_of(scene);
      joints->add(rods, branching(kind));
      auto held = std::make_shared<Attachment>();
      held->add(rods, pin_of(rods, 0, 6));
      all.push_back(held);
      Stepper stepper(rods, std::move(all), precise(), nullptr, std::move(joints));
      settle(stepper);
      const RodForces forces = stepper.forces();
      ASSERT_EQ(forces.joints.size(), 3U);
      Vector3d force = Vector3d::Zero();
      Vector3d moment = Vector3d::Zero();
      double load = 0.0;
      double moments = 0.0;
      for (const RodForces::JointForce& each : forces.joints) {
        force += each.force;
        moment += each.moment;
        moments += each.moment.norm();
        // Each of the two lower branches hangs from the joint alone, by its weight and moment.
        if (each.rod > 0) {
          double weight = 0.0;
          Vector3d turning = each.moment;
          for (std::uint32_t i = rods.first(each.rod); i < rods.end(each.rod); ++i) {
            const Vector3d pull(0.0, 0.0, -gravity * rods.masses[i]);
            weight += gravity * rods.masses[i];
            turning += (stepper.rods().positions[i] - each.point).cross(pull);
          }
          load += weight;
          EXPECT_NEAR((each.force - Vector3d(0.0, 0.0, weight)).norm(), 0.0, 1e-6 * weight);
          EXPECT_NEAR(turning.norm(), 0.0, 1e-6 * weight);
        }
      }
      EXPECT_LE(force.norm(), 1e-6 * load);
      EXPECT_LE(moment.norm(), 1e-6 * (moments + 1.0));
      EXPECT_EQ(moments > 1e-3, kind == Joints::Kind::WELD);
    }
  }
}

/// An angle of two rods of which one is clamped: its end sinks by bending of both and by twist.
TEST(Joints, WeldedCornerBendsAndTwists) {
  constexpr int segments = 40;
  const double bending = 2.0;
  const double twisting = 1.0;
  const double arm = 0.3;
  const double reach = 0.2;
  Rods rods;
  const RodSection light{1e5, bending, twisting, 1e-6, 1e-9};
  rods.add(straight({0.0, 0.0, 0.0}, {arm, 0.0, 0.0}, segments), 0.004, light);
  rods.add(straight({arm, 0.0, 0.0}, {arm, reach, 0.0}, segments), 0.004, light);
  rods.add(straight({arm, reach, 0.0}, {arm, reach, -0.1}, 1), 0.004, {1e5, 0.0, 1e-3, 0.1, 1e-6});
  Scene scene;
  scene.has_twist = true;
  Effects all = effects_of(rods, scene);
  auto joints = joints_of(scene);
  joints->add(rods, {Joints::Kind::WELD, {{0, segments}, {1, 0}}});
  joints->add(rods, {Joints::Kind::BALL, {{1, segments}, {2, 0}}});
  auto held = std::make_shared<Attachment>();
  held->add(rods, clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), rods.directors[0]}));
  all.push_back(held);
  Stepper stepper(rods, std::move(all), precise(), nullptr, std::move(joints));
  settle(stepper);
  const double load = 0.01 * gravity;
  const double sinks =
      load * (arm * arm * arm / 3.0 / bending + reach * reach * reach / 3.0 / bending +
              arm * reach * reach / twisting);
  EXPECT_NEAR(-stepper.rods().positions[2 * segments + 1].z(), sinks, 5e-3 * sinks);
}

Vector3d angular_momentum_of(const Rods& rods) {
  Vector3d sum = Vector3d::Zero();
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    sum += rods.masses[i] * rods.positions[i].cross(rods.velocities[i]);
  }
  return sum;
}

Effects free_of_gravity(Rods& rods, bool has_twist) {
  Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>());
  if (has_twist) {
    all.push_back(std::make_unique<Twist>(rods));
  }
  return all;
}

TEST(Joints, KeepMomentum) {
  for (const Joints::Kind kind : {Joints::Kind::BALL, Joints::Kind::WELD}) {
    for (const bool has_twist : {false, true}) {
      Rods rods = branches();
      Effects all = free_of_gravity(rods, has_twist);
      auto joints = joints_of({});
      joints->add(rods, branching(kind));
      throw_rods(rods);
      for (double& spin : rods.spins) {
        spin = 0.0;
      }
      joints->unite(rods);
      const Vector3d momentum = momentum_of(rods);
      const Vector3d angular = angular_momentum_of(rods);
      Stepper stepper(rods, std::move(all), precise(Integrator::BDF2), nullptr, std::move(joints));
      for (int i = 0; i < 400; ++i) {
        stepper.step(0.0005);
        ASSERT_LE((momentum_of(stepper.rods()) - momentum).norm(), 1e-12);
      }
      EXPECT_LE((angular_momentum_of(stepper.rods()) - angular).norm(), 1e-3 * angular.norm());
      EXPECT_EQ(stepper.rods().positions[0], stepper.rods().positions[rods.first(2)]);
    }
  }
}

/// As ImplicitEulerGainsNoEnergy, which is of rods that are not joined.
TEST(Joints, ImplicitEulerGainsNoEnergy) {
  SCOPED_TRACE(seed_message());
  Random random(11);
  for (int round = 0; round < 12; ++round) {
    SCOPED_TRACE(round);
    Rods rods = branches(random.uniform(0.3, 1.0));
    Effects all = free_of_gravity(rods, round % 4 > 1);
    const double relaxation = round % 3 == 0 ? 0.02 : 0.0;
    auto joints = std::make_unique<Joints>(Joints::Options{true, relaxation});
    joints->add(rods, branching(round % 2 == 0 ? Joints::Kind::BALL : Joints::Kind::WELD));
    give_velocities(rods, random, 1.0);
    Stepper stepper(rods, std::move(all), precise(), nullptr, std::move(joints));
    const double step = std::pow(10.0, random.uniform(-3.0, -2.0));
    stepper.step(step);
    double before = stepper.energy();
    const double first = before;
    for (int i = 0; i < 100; ++i) {
      stepper.step(step);
      const double after = stepper.energy();
      ASSERT_LE(after, before + 1e-9 * first) << i;
      ASSERT_NEAR(stepper.report().energy_gain, after - before, 1e-9 * first);
      before = after;
    }
  }
}

/// Energies and their derivatives of a random weld, away from its rest.
TEST(Joints, DerivativesOfWelds) {
  SCOPED_TRACE(seed_message());
  Random random(12);
  for (int round = 0; round < 40; ++round) {
    SCOPED_TRACE(round);
    Rods rods = rods_of_equal_sizes(random, 2, 3, 0.3);
    if (round % 2 == 0) {
      const Twist twist(rods);
    }
    Weld weld = make_weld(rods, {{{0, 1, 2, 1.0}, {1, 3, 3, 1.0}}}, WeldPath::SHORTER);
    weld.bending = random.uniform(0.5, 2.0);
    weld.twisting = random.uniform(0.5, 2.0);
    ASSERT_NEAR(WeldStrain(weld, rods, rods).energy(), 0.0, 1e-15);
    weld.damping_share = round % 3 == 0 ? 0.7 : 0.0;
    weld.earlier_strain = WeldStrain(weld, rods, rods).strain();
    displace(rods, random, 0.05, 0.4);
    const WeldStrain strain(weld, rods, rods);
    const WeldStrain::Derivatives found = strain.derivatives();
    const auto energy = [&] { return WeldStrain(weld, rods, rods).energy(); };
    for (std::size_t side = 0; side < 2; ++side) {
      const std::uint32_t edge = weld.edges[side].edge;
      const bool has_twist = !rods.angles.empty();
      for (Eigen::Index i = 0; i < (has_twist ? 7 : 6); ++i) {
        const Eigen::Index node = i / (has_twist ? 4 : 3);
        const Eigen::Index part = i % (has_twist ? 4 : 3);
        double& x = part == 3 ? rods.angles[edge] : rods.positions[edge + node][part];
        const double middle = x;
        constexpr double difference = 1e-6;
        x = middle + difference;
        const double after = energy();
        x = middle - difference;
        const double before = energy();
        x = middle;
        EXPECT_NEAR(found.gradient[side][i], (after - before) / (2.0 * difference), 1e-7)
            << side << " " << i;
      }
    }
  }
}

TEST(Joints, DoNotDependOnThreads) {
  const auto run = [](std::uint32_t threads) {
    Rods rods;
    for (int i = 0; i < 12; ++i) {
      rods.add(straight({0.1 * i, 0.0, 0.0}, {0.1 * i, 0.3, 0.01 * i}, 9), 0.004, section_of(0.01));
      rods.add(straight({0.1 * i, 0.3, 0.01 * i}, {0.1 * i, 0.5, 0.2}, 5), 0.004, section_of(0.01));
    }
    auto joints = joints_of({});
    for (std::uint32_t i = 0; i < 12; ++i) {
      joints->add(rods, {i % 2 == 0 ? Joints::Kind::WELD : Joints::Kind::BALL,
                         {{2 * i, 9}, {2 * i + 1, 0}}});
    }
    throw_rods(rods);
    Effects all = effects_of(rods, {});
    StepperOptions options;
    options.threads = threads;
    Stepper stepper(rods, std::move(all), options, nullptr, std::move(joints));
    for (int i = 0; i < 20; ++i) {
      stepper.step(0.004);
    }
    return stepper.rods().positions;
  };
  EXPECT_EQ(run(1), run(4));
}

}  // namespace
}  // namespace fiber::test
