// Joined and closed rods: what is joined moves as one, and forces and moments go through.

#include "fiber_proximity/sim/joints.hpp"

#include <gtest/gtest.h>

#include "src/sim/effects/natural_bend.hpp"
#include "test/sim/joint_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

TEST(Joints, RodCutAndWeldedMovesAsTheWholeOne) {
  constexpr int segments = 14;
  constexpr int cut = 5;
  for (const JointScene& scene : joint_scenes()) {
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
    for (const JointScene& scene : joint_scenes()) {
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
  const double weight = 10.0 * 0.2 * standard_gravity;
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

TEST(Joints, ForcesOfBranchesBalance) {
  for (const Joints::Kind kind : {Joints::Kind::BALL, Joints::Kind::WELD}) {
    for (const bool has_twist : {false, true}) {
      Rods rods = branches();
      JointScene scene;
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
            const Vector3d pull(0.0, 0.0, -standard_gravity * rods.masses[i]);
            weight += standard_gravity * rods.masses[i];
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
  JointScene scene;
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
  const double load = 0.01 * standard_gravity;
  const double sinks =
      load * (arm * arm * arm / 3.0 / bending + reach * reach * reach / 3.0 / bending +
              arm * reach * reach / twisting);
  EXPECT_NEAR(-stepper.rods().positions[2 * segments + 1].z(), sinks, 5e-3 * sinks);
}

}  // namespace
}  // namespace fiber::test
