#include "benchmark/environment/cell.hpp"

#include <string>
#include <utility>

#include "benchmark/environment/arm.hpp"
#include "benchmark/environment/capsule_mesh.hpp"
#include "src/scenes/portable_math.hpp"

namespace fiber {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;

constexpr double cable_radius = 0.004;          // [m]
constexpr double cable_length = 1.5;            // [m] from end to end
constexpr double sways_per_period = 4.0 / 3.0;  // of the arm

Isometry3d at(double x, double y, double z) {
  Isometry3d pose = Isometry3d::Identity();
  pose.translation() = Vector3d(x, y, z);
  return pose;
}

/// Lying: the z axis along the table, turned about the upright.
Isometry3d lying(double x, double y, double z, double turns) {
  Isometry3d pose = at(x, y, z);
  const double c = cosine_of_turns(turns);
  const double s = sine_of_turns(turns);
  pose.linear() << 0.0, -s, c, 0.0, c, s, -1.0, 0.0, 0.0;
  return pose;
}

/// The table, whose top is z = 0, with its legs, a wall, and what stands and lies on it: between
/// the cables, some of it so wide that they touch it at times.
std::vector<std::pair<Shape, Isometry3d>> solids() {
  std::vector<std::pair<Shape, Isometry3d>> all{
      {BoxShape{{1.8, 1.8, 0.05}}, at(0.0, 0.0, -0.025)},
      {BoxShape{{0.05, 1.8, 1.2}}, at(-0.95, 0.0, 0.6)},
      {BoxShape{{0.08, 0.10, 0.12}}, at(0.18, 0.30, 0.06)},
      {BoxShape{{0.10, 0.08, 0.04}}, at(-0.30, 0.30, 0.02)},
      {BoxShape{{0.06, 0.06, 0.06}}, lying(0.42, -0.42, 0.03, 0.07)},
      {SphereShape{0.055}, at(-0.06, -0.42, 0.055)},
      {SphereShape{0.030}, at(0.42, -0.18, 0.030)},
      {SphereShape{0.050}, at(-0.30, -0.18, 0.050)},
      {CylinderShape{0.050, 0.15}, at(0.42, 0.06, 0.075)},
      {CylinderShape{0.030, 0.08}, lying(0.18, -0.42, 0.030, 0.05)},
      {CylinderShape{0.060, 0.10}, at(-0.06, 0.30, 0.05)},
      {ConeShape{0.055, 0.12}, at(0.18, 0.06, 0.06)},
      {ConeShape{0.040, 0.20}, at(0.42, 0.30, 0.10)},
      {CapsuleShape{0.030, 0.06}, lying(0.18, -0.18, 0.030, 0.2)},
      {CapsuleShape{0.020, 0.10}, at(-0.06, 0.06, 0.07)},
      {CapsuleShape{0.030, 0.07}, lying(-0.30, 0.06, 0.030, 0.3)},
  };
  for (const double x : {-0.85, 0.85}) {
    for (const double y : {-0.85, 0.85}) {
      all.emplace_back(CylinderShape{0.04, 0.7}, at(x, y, -0.4));
    }
  }
  return all;
}

const Vector3d& robot_base() {
  static const Vector3d base(-0.85, 0.0, 0.11);
  return base;
}

Isometry3d link_pose(const Isometry3d& in_base) {
  Isometry3d pose = in_base;
  pose.translation() += robot_base();
  return pose;
}

/// A cable in waves, sideways and up and down, that sways.
struct Wave {
  Vector3d begin;
  Vector3d along;     // to the end [m]
  Vector3d sideways;  // [m] how far
  double lift;        // [m] how far the crests are above the troughs
  double turns;       // of the waves along the cable
  double phase;       // [turns]

  /// At u from 0 to 1 and a phase of the sway [turns].
  Vector3d at(double u, double sway) const {
    const double side = sine_of_turns(turns * u + phase + 0.1 * sine_of_turns(sway + phase));
    const double crest = 0.5 + 0.5 * sine_of_turns(1.5 * turns * u + 2.0 * phase + 0.25 * side);
    return begin + u * along + side * sideways + Vector3d(0.0, 0.0, crest * crest * lift);
  }
};

/// Every other cable lies along x, the others along y and a little higher, so that they cross.
Wave wave_of(std::uint32_t cable, std::uint32_t cables) {
  const bool crosses = cable % 2 != 0;
  const double place = 1.2 * ((cable + 0.5) / cables - 0.5);
  const double height = cable_radius + (crosses ? 0.009 : 0.002);
  const double half = cable_length / 2.0;
  Wave wave;
  wave.begin = {-half, place, height};
  wave.along = {cable_length, 0.0, 0.0};
  wave.sideways = {0.0, 0.06, 0.0};
  wave.lift = 0.06;
  wave.turns = 1.5;
  wave.phase = 0.31 * cable;
  if (crosses) {
    wave.begin = {place, -half, height};
    wave.along = {0.0, cable_length, 0.0};
    wave.sideways = {0.05, 0.0, 0.0};
    wave.lift = 0.10;
    wave.turns = 2.0;
  }
  return wave;
}

}  // namespace

Cell::Cell(const CellSize& size) : size_(size) {
  const auto poses = arm_poses(0.0);
  for (std::size_t i = 0; i < arm_link_count; ++i) {
    const ArmLink& link = arm_links()[i];
    objects_.push_back({link.name,
                        link_pose(poses[i]),
                        {{capsule_mesh(link.radius, link.length, size.triangles)}}});
  }
  for (const auto& [shape, pose] : solids()) {
    objects_.push_back({"solid" + std::to_string(objects_.size()), pose, {{shape}}});
  }
}

std::vector<ObjectChange> Cell::moves(std::uint32_t frame) const {
  std::vector<ObjectChange> changes;
  const auto poses = arm_poses(frame / (size_.frames_per_sway * sways_per_period));
  for (std::size_t i = 0; i < arm_link_count; ++i) {
    changes.push_back({ObjectChange::Operation::MOVE, {objects_[i].name, link_pose(poses[i]), {}}});
  }
  return changes;
}

std::vector<Vector3d> Cell::points(std::uint32_t frame) const {
  std::vector<Vector3d> points;
  for (std::uint32_t cable = 0; cable < size_.cables; ++cable) {
    const Wave wave = wave_of(cable, size_.cables);
    for (std::uint32_t i = 0; i < size_.points; ++i) {
      points.push_back(
          wave.at(static_cast<double>(i) / (size_.points - 1), frame / size_.frames_per_sway));
    }
  }
  return points;
}

FiberAssembly Cell::cables(std::uint32_t frame) const {
  std::vector<std::uint32_t> offsets;
  for (std::uint32_t cable = 0; cable <= size_.cables; ++cable) {
    offsets.push_back(cable * size_.points);
  }
  return {points(frame), std::move(offsets), {cable_radius}};
}

FiberAssembly candidate_cable(std::uint32_t points, std::uint64_t seed) {
  Random random(seed);
  Vector3d along = random.direction();
  along.z() *= 0.2;
  along = cable_length * unit(along);
  Vector3d middle = random.point_in_cube(-0.4, 0.4);
  middle.z() = random.uniform(0.2, 0.6);
  const Vector3d sideways =
      random.uniform(0.0, 0.1) * perpendicular_unit(Vector3d::UnitZ(), unit(along));
  const Wave wave{
      middle - along / 2.0,    along, sideways, random.uniform(0.0, 0.1), random.uniform(0.5, 3.0),
      random.uniform(0.0, 1.0)};
  std::vector<Vector3d> all;
  for (std::uint32_t i = 0; i < points; ++i) {
    all.push_back(wave.at(static_cast<double>(i) / (points - 1), 0.0));
  }
  return {std::move(all), {0, points}, {cable_radius}};
}

}  // namespace fiber
