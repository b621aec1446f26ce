#include "validation/sim/harness_scene.hpp"

#include <cmath>
#include <memory>
#include <numeric>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/attachment.hpp"
#include "fiber_proximity/sim/joints.hpp"
#include "validation/sim/moving_scene.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr double height = 1.0;  // of the arm's flange over the ground [m]
constexpr double branch_length = 0.6;
constexpr double plug_length = 0.04;
constexpr double branch_radius = 0.003;
constexpr double plug_radius = 0.008;
constexpr double clip_at = 0.42;  // of a branch's nodes

/// Where the arm is, from where it begins at rest.
Vector3d way_of_arm(double time) {
  constexpr double period = 2.0;  // [s]
  const double share = 0.5 - 0.5 * std::cos(2.0 * M_PI * time / period);
  return share * Vector3d(0.0, 0.3, 0.1);
}

/// On a cone about the arm.
Vector3d direction_of(std::uint32_t branch, const HarnessSize& size) {
  constexpr double opening = 1.2;  // [rad]
  const double angle = 2.0 * M_PI * (branch + 0.5) / size.branches;
  return {std::cos(opening), std::sin(opening) * std::cos(angle),
          std::sin(opening) * std::sin(angle)};
}

bool has_plug(std::uint32_t branch) { return branch % 2 == 0; }

void add_trunk(const HarnessSize& size, Rods& rods) {
  constexpr double radius = 0.004;
  constexpr double length = 0.5;
  constexpr double bow = 0.15;
  std::vector<Vector3d> points;
  for (std::uint32_t i = 0; i <= size.segments; ++i) {
    const double along = static_cast<double>(i) / size.segments - 1.0;
    points.emplace_back(length * along, bow * std::sin(M_PI * along), height);
  }
  rods.add(points, radius, solid_round_section(material_preset("power_cable"), radius));
}

void add_branch(std::uint32_t branch, const HarnessSize& size, Rods& rods) {
  const auto segments = static_cast<int>(size.segments);
  const Vector3d start(0.0, 0.0, height);
  const Vector3d end = start + branch_length * direction_of(branch, size);
  const RodSection cable = solid_round_section(material_preset("power_cable"), branch_radius);
  if (!has_plug(branch)) {
    rods.add(straight(start, end, segments), branch_radius, cable);
    return;
  }
  constexpr double cable_share = 1.0 - plug_length / branch_length;
  std::vector<Vector3d> points = straight(start, start + cable_share * (end - start), segments - 1);
  points.push_back(end);
  rods.add(points, branch_radius, cable);
  RodMaterial material = material_preset("power_cable");
  material.density = 3000.0;
  const auto first = rods.rest_lengths.begin() + rods.first(rods.count() - 1);
  const double begin = std::accumulate(first, first + (segments - 1), 0.0);
  RodSectionPart plug{{begin, begin + *(first + (segments - 1))},
                      solid_round_section(material, plug_radius)};
  plug.radius = plug_radius;
  plug.is_rigid = true;
  rods.set_sections(rods.count() - 1, {plug});
}

/// Pins that go with the arm from where their nodes begin.
std::unique_ptr<Attachment> clips(const Rods& rods, const HarnessSize& size) {
  auto attachment = std::make_unique<Attachment>();
  const auto add = [&](std::uint32_t rod, std::uint32_t node) {
    const Vector3d begin = rods.positions[rods.first(rod) + node];
    Attachment::Hold clip = pin(node, begin);
    clip.rod = rod;
    clip.placement = [begin](double time) {
      return Placement{begin + way_of_arm(time), Vector3d::Zero(), Vector3d::Zero()};
    };
    attachment->add(rods, clip);
  };
  add(0, 0);
  add(0, size.segments);
  for (std::uint32_t branch = 0; branch < size.branches; ++branch) {
    add(1 + branch, static_cast<std::uint32_t>(std::lround(clip_at * size.segments)));
    if (!has_plug(branch)) {
      add(1 + branch, size.segments);
    }
  }
  return attachment;
}

std::unique_ptr<Contacts> contacts_of_harness() {
  const Shape arm = BoxShape{{0.55, 0.4, 0.04}};
  const auto placement = [](double time) {
    return at_place(Vector3d(-0.3, -0.08, height - 0.06) + way_of_arm(time));
  };
  return contacts_with_moving({moving("arm", arm, placement)}, 0.3, {},
                              environment_of(HalfSpaceShape{Vector3d::UnitZ(), 0.3}));
}

}  // namespace

Stepper harness_on_an_arm(const HarnessSize& size, const StepperOptions& options) {
  Rods rods;
  add_trunk(size, rods);
  std::vector<JointNode> ends{{0, size.segments}};
  for (std::uint32_t branch = 0; branch < size.branches; ++branch) {
    add_branch(branch, size, rods);
    ends.push_back({1 + branch, 0});
  }
  Effects effects = elastic(standard_gravity);
  effects.push_back(clips(rods, size));
  auto joints = std::make_unique<Joints>(Joints::Options{});
  joints->add(rods, {Joints::Kind::WELD, ends});
  return {std::move(rods), std::move(effects), options, contacts_of_harness(), std::move(joints)};
}

}  // namespace fiber
