// Joined and closed rods that bend more easily to one side than to another.

#include <gtest/gtest.h>

#include <algorithm>

#include "fiber_proximity/sim/loads.hpp"
#include "src/sim/effects/natural_bend.hpp"
#include "test/sim/joint_scenes.hpp"

namespace fiber::test {
namespace {

using Eigen::Vector3d;

constexpr double strip_ratio = 6.0;

RodSection strip_of(double bending) { return {2000.0, bending, 1e-3, 0.05, 1e-6, strip_ratio}; }

/// With twist and damping, by which strips differ from rods.
const JointScene strip_scene{true, false, 0.01, Integrator::BDF2};

/// Effects of strips with these sides.
Effects effects_of_strips(Rods& rods, const std::vector<Vector3d>& sides) {
  Effects all = effects_of(rods, strip_scene);
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    rods.set_stiff_side(rod, sides[rod]);
  }
  all.push_back(std::make_shared<AnisotropicBend>());
  all.push_back(
      std::make_shared<AnisotropicDamping>(std::make_shared<Damping>(strip_scene.relaxation_time)));
  return all;
}

/// Also where the second half goes the other way, and where both have sections of their own.
TEST(WeldedStrips, OneThatIsCutMovesAsTheWholeOne) {
  constexpr int segments = 14;
  constexpr int cut = 5;
  const std::vector<Vector3d> points = straight(Vector3d::Zero(), {0.6, 0.3, 0.2}, segments);
  const Vector3d side(0.2, 0.0, 1.0);
  enum class Kind { WHOLE, CUT, CUT_AND_TURNED };
  const auto moved = [&](Kind kind, bool has_sections) {
    std::vector<Vector3d> second(points.begin() + cut, points.end());
    if (kind == Kind::CUT_AND_TURNED) {
      std::reverse(second.begin(), second.end());
    }
    Rods rods;
    if (kind == Kind::WHOLE) {
      rods.add(points, 0.004, strip_of(0.01));
    } else {
      rods.add({points.begin(), points.begin() + cut + 1}, 0.004, strip_of(0.01));
      rods.add(second, 0.004, strip_of(0.01));
    }
    const double edge = rods.rest_lengths.front();
    if (has_sections) {  // stiff and round around the cut, from within an edge into one
      const RodSection other{2000.0, 0.03, 2e-3, 0.05, 1e-6, 1.0};
      const double from = 3.4 * edge;
      const double to = 7.3 * edge;
      if (kind == Kind::WHOLE) {
        rods.set_sections(0, {{{from, to}, other}});
      } else {
        const double shared = cut * edge - 1e-12;
        const double rest = to - cut * edge;
        const double length = (segments - cut) * edge - 1e-12;
        rods.set_sections(0, {{{from, shared}, other}});
        rods.set_sections(
            1, {{kind == Kind::CUT ? RodPart{0.0, rest} : RodPart{length - rest, length}, other}});
      }
    }
    Effects all = effects_of_strips(rods, {side, side});
    std::unique_ptr<Joints> joints;
    if (kind != Kind::WHOLE) {
      joints = joints_of(strip_scene);
      const std::uint32_t node = kind == Kind::CUT ? 0 : segments - cut;
      joints->add(rods, {Joints::Kind::WELD, {{1, node}, {0, cut}}});
    }
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      rods.velocities[i] = velocity_at(rods.positions[i]);
    }
    auto held = std::make_shared<Attachment>();
    held->add(rods, pin_of(rods, 0, 0));
    all.push_back(held);
    Stepper stepper(rods, std::move(all), options_of(strip_scene), nullptr, std::move(joints));
    for (int i = 0; i < 100; ++i) {
      stepper.step(0.004);
    }
    std::vector<Vector3d> end = stepper.rods().positions;
    if (kind == Kind::CUT_AND_TURNED) {
      std::reverse(end.begin() + cut + 1, end.end());
    }
    if (kind != Kind::WHOLE) {
      EXPECT_EQ(end[cut], end[cut + 1]);
      end.erase(end.begin() + cut);
    }
    return end;
  };
  for (const bool has_sections : {false, true}) {
    const std::vector<Vector3d> whole = moved(Kind::WHOLE, has_sections);
    ASSERT_GT((whole.back() - points.back()).norm(), 0.2);
    for (const Kind kind : {Kind::CUT, Kind::CUT_AND_TURNED}) {
      SCOPED_TRACE(testing::Message() << has_sections << static_cast<int>(kind));
      const std::vector<Vector3d> welded = moved(kind, has_sections);
      for (std::size_t i = 0; i < whole.size(); ++i) {
        EXPECT_LE((whole[i] - welded[i]).norm(), 1e-7) << i;
      }
    }
  }
}

/// A flat belt, which is straight by nature.
TEST(WeldedStrips, PlaceOfTheSeamDoesNotMatter) {
  constexpr int segments = 20;
  const auto moved = [&](int seam) {
    std::vector<Vector3d> points;
    for (int i = 0; i <= segments; ++i) {
      const double angle = 2.0 * M_PI * ((i + seam) % segments) / segments;
      points.emplace_back(0.2 * std::sin(angle), 0.0, 0.2 * std::cos(angle));
    }
    Rods rods;
    rods.add(points, 0.004, strip_of(0.002));
    Effects all = effects_of_strips(rods, {Vector3d::UnitY()});
    auto joints = joints_of(strip_scene);
    joints->close(rods, 0);
    for (std::size_t i = 0; i < rods.positions.size(); ++i) {
      rods.velocities[i] = velocity_at(rods.positions[i]);
    }
    auto held = std::make_shared<Attachment>();
    held->add(rods, pin_of(rods, 0, static_cast<std::uint32_t>((segments - seam) % segments)));
    all.push_back(held);
    Stepper stepper(rods, std::move(all), options_of(strip_scene), nullptr, std::move(joints));
    for (int i = 0; i < 60; ++i) {
      stepper.step(0.004);
    }
    std::vector<Vector3d> found(segments);
    for (int i = 0; i < segments; ++i) {
      found[static_cast<std::size_t>((i + seam) % segments)] =
          stepper.rods().positions[static_cast<std::size_t>(i)];
    }
    return found;
  };
  const std::vector<Vector3d> first = moved(0);
  ASSERT_GT((first[10] - Vector3d(0.0, 0.0, -0.2)).norm(), 0.02);
  for (const int seam : {7, 12}) {
    const std::vector<Vector3d> other = moved(seam);
    for (std::size_t i = 0; i < first.size(); ++i) {
      EXPECT_LE((first[i] - other[i]).norm(), 1e-7) << seam << " " << i;
    }
  }
}

/// A right angle of two strips of which one is clamped, loaded in its plane and across it. In its
/// plane both arms bend, across it the one also twists.
TEST(WeldedStrips, ACornerBendsByBothStiffnesses) {
  constexpr int segments = 60;
  constexpr double bending = 2.0;
  constexpr double twisting = 1.0;
  constexpr double arm = 0.3;
  constexpr double reach = 0.2;
  constexpr double force = 1e-3;
  const RodSection section{1e5, bending, twisting, 0.1, 1e-4, strip_ratio};
  // Flat in the plane of the corner, or upright in it.
  for (const bool is_flat : {true, false}) {
    SCOPED_TRACE(is_flat);
    Rods rods;
    rods.add(straight({0.0, 0.0, 0.0}, {arm, 0.0, 0.0}, segments), 0.004, section);
    rods.add(straight({arm, 0.0, 0.0}, {arm, reach, 0.0}, segments), 0.004, section);
    Effects all = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                          std::make_unique<Twist>(rods), std::make_unique<AnisotropicBend>());
    rods.set_stiff_side(0, is_flat ? Vector3d::UnitY() : Vector3d::UnitZ());
    rods.set_stiff_side(1, is_flat ? Vector3d::UnitX() : Vector3d::UnitZ());
    auto joints = joints_of({});
    joints->add(rods, {Joints::Kind::WELD, {{0, segments}, {1, 0}}});
    auto held = std::make_shared<Attachment>();
    held->add(rods, clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), rods.directors[0]}));
    all.push_back(held);
    auto loads = std::make_shared<Loads>();
    Loads::Load load;
    load.rod = 1;
    load.node = segments;
    load.force = TimeTable<Vector3d>(force * Vector3d(-1.0, 0.0, -1.0));
    loads->add(rods, load);
    all.push_back(loads);
    Stepper stepper(rods, std::move(all), precise(), nullptr, std::move(joints));
    settle(stepper);
    const Vector3d moved = stepper.rods().positions.back() - Vector3d(arm, reach, 0.0);
    const double in_plane = is_flat ? strip_ratio * bending : bending;
    const double across = is_flat ? bending : strip_ratio * bending;
    const double along_x = force * (reach * reach * reach / 3.0 + reach * reach * arm) / in_plane;
    const double along_z = force * ((arm * arm * arm + reach * reach * reach) / 3.0 / across +
                                    arm * reach * reach / twisting);
    EXPECT_NEAR(-moved.x(), along_x, 5e-3 * along_x);
    EXPECT_NEAR(-moved.z(), along_z, 5e-3 * along_z);
  }
}

}  // namespace
}  // namespace fiber::test
