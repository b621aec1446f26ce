#include "src/sim/scene/fibers.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <set>

#include "src/sim/resolution.hpp"
#include "src/sim/scene/cut_curve.hpp"
#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/named_nodes.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/sim/scene/sections.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

/// The number of segments in which the turning of a curve is measured.
constexpr std::int64_t fine_segments = 1000;

constexpr std::int64_t min_closed_segments = 3;

double length_of(const std::vector<Eigen::Vector3d>& curve) {
  double length = 0.0;
  for (std::size_t i = 1; i < curve.size(); ++i) {
    length += (curve[i] - curve[i - 1]).norm();
  }
  return length;
}

void measure_turning(FiberEntry& fiber) {
  const std::vector<Eigen::Vector3d> points = resample(fiber.curve, fine_segments);
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Eigen::Vector3d before = points[i - 1] - points[i - 2];
    const Eigen::Vector3d after = points[i] - points[i - 1];
    fiber.turning += std::atan2(before.cross(after).norm(), before.dot(after));
  }
}

std::string speed_limit() {
  return "at most " + std::to_string(static_cast<int>(max_initial_speed)) + " m/s";
}

Eigen::Vector3d read_velocity(const YamlField& field) {
  const Eigen::Vector3d velocity = field.vector();
  if (!(velocity.norm() <= max_initial_speed)) {
    field.refuse("finite and " + speed_limit());
  }
  return velocity;
}

void read_velocities(const YamlField& entry, FiberEntry& fiber) {
  const auto velocity = entry.find("velocity");
  const auto list = entry.find("velocities");
  if (velocity) {
    fiber.velocities = {read_velocity(*velocity)};
  }
  if (list) {
    if (velocity) {
      list->refuse("absent where there is a velocity");
    }
    for (const YamlField& each : list->items()) {
      fiber.velocities.push_back(read_velocity(each));
    }
    if (fiber.velocities.size() < 2) {
      list->refuse("a list of at least two velocities");
    }
  }
  if (const auto angular = entry.find("angular_velocity")) {
    fiber.angular_velocity = angular->vector();
    if (!fiber.angular_velocity.allFinite()) {
      angular->refuse("finite");
    }
  }
}

/// Gives the last rod, which is that of an entry, its velocities to begin with.
void set_velocities(const FiberEntry& entry, Rods& rods) {
  const std::uint32_t first = rods.first(rods.count() - 1);
  const std::uint32_t last = rods.end(rods.count() - 1) - 1;
  const double of_surface = entry.angular_velocity.norm() * rods.radii.back();
  if (!(of_surface <= max_initial_speed)) {
    throw std::invalid_argument("its surface begins with " + std::to_string(of_surface) +
                                " m/s about its axis, it must be " + speed_limit());
  }
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  double mass = 0.0;
  for (std::uint32_t i = first; i <= last; ++i) {
    center += rods.masses[i] * rods.positions[i];
    mass += rods.masses[i];
  }
  center /= mass;
  double length = 0.0;
  for (std::uint32_t i = first; i < last; ++i) {
    length += rods.rest_lengths[i];
  }
  double at = 0.0;  // along the fibre [m]
  for (std::uint32_t i = first; i <= last; ++i) {
    Eigen::Vector3d velocity = entry.angular_velocity.cross(rods.positions[i] - center);
    if (!entry.velocities.empty()) {
      const double place =
          std::min(1.0, at / length) * static_cast<double>(entry.velocities.size() - 1);
      const auto before = static_cast<std::size_t>(place);
      const std::size_t after = std::min(before + 1, entry.velocities.size() - 1);
      const double share = place - static_cast<double>(before);
      velocity += (1.0 - share) * entry.velocities[before] + share * entry.velocities[after];
    }
    if (!(velocity.norm() <= max_initial_speed)) {
      throw std::invalid_argument("point " + std::to_string(i - first) + " begins with " +
                                  std::to_string(velocity.norm()) + " m/s, it must be " +
                                  speed_limit());
    }
    rods.velocities[i] = velocity;
    at += rods.rest_lengths[i];
  }
}

/// Leads a curve back to where it begins.
void close_curve(const YamlField& closed, std::vector<Eigen::Vector3d>& curve) {
  constexpr std::size_t min_points = 3;
  constexpr double rounding = 1e-9;  // of the length
  if ((curve.back() - curve.front()).norm() <= rounding * length_of(curve)) {
    curve.pop_back();
  }
  if (curve.size() < min_points) {
    closed.refuse(
        "absent or false where the shape is straight: it must have three points at least");
  }
  curve.push_back(curve.front());
}

/// Whether any of it is stiffer towards one side than across that.
bool is_anisotropic(const FiberEntry& fiber) {
  return fiber.section.bending_ratio > 1.0 ||
         std::any_of(fiber.sections.begin(), fiber.sections.end(),
                     [](const SectionEntry& each) { return each.section.bending_ratio > 1.0; });
}

void read_stiff_side(const YamlField& entry, FiberEntry& fiber) {
  const auto towards = entry.find("stiff_towards");
  if (!is_anisotropic(fiber)) {
    if (towards) {
      towards->refuse("absent where no material has a bending_ratio above 1");
    }
    return;
  }
  const YamlField field = entry.get("stiff_towards");
  fiber.stiff_side = SimStiffSide{field.vector(), field.statement()};
}

void read_body(const YamlField& entry, bool chooses_segments, FiberEntry& fiber) {
  const auto closed = entry.find("closed");
  fiber.is_closed = closed && closed->flag();
  if (!chooses_segments || entry.find("segments")) {
    const YamlField segments = entry.get("segments");
    fiber.segments = segments.integer(1, max_segments);
    if (fiber.is_closed && *fiber.segments < min_closed_segments) {
      segments.refuse("at least " + std::to_string(min_closed_segments) + " of a closed fibre");
    }
  }
  fiber.curve = read_shape(entry.get("shape"));
  if (fiber.is_closed) {
    close_curve(*closed, fiber.curve);
  }
  fiber.length = length_of(fiber.curve);
  if (chooses_segments) {
    measure_turning(fiber);
  }
  read_velocities(entry, fiber);
  fiber.radius = entry.get("radius").number();
  const YamlField given = entry.get("material");
  const RodMaterial material = read_material(given, RodMaterial(), fiber.material_defaults);
  fiber.section =
      with_context(given.place(), [&] { return solid_round_section(material, fiber.radius); });
  if (fiber.length > 0.0) {  // without a length it is refused when it is cut
    fiber.sections = read_sections(entry, {material, fiber.radius, fiber.length});
  }
  read_stiff_side(entry, fiber);
}

FiberEntry read_fiber(const YamlField& entry, bool chooses_segments) {
  entry.require_map(key_names("fiber"));
  FiberEntry fiber;
  fiber.name = entry.get("name").text();
  fiber.place = entry.place();
  with_fiber_name(fiber.name, [&] { read_body(entry, chooses_segments, fiber); });
  if (const auto repeat = entry.find("repeat")) {
    repeat->require_map(key_names("repeat"));
    fiber.repeat_place = repeat->place();
    fiber.count = repeat->get("count").integer(1, max_repeats);
    fiber.offset = repeat->get("offset").vector();
  }
  return fiber;
}

/// Adds the rods of an entry, each moved by the offset from the one before.
void add(const FiberEntry& entry, std::int64_t segments, SimDescription& scene) {
  if (!entry.material_defaults.empty()) {
    scene.material_defaults.push_back(
        format("the material of fibre ", quote(entry.name),
               " leaves values open, for which are taken: ", entry.material_defaults));
  }
  NodesAt nodes;
  with_fiber_name(entry.name, [&] { nodes = nodes_of(entry, segments); });
  const std::vector<Eigen::Vector3d> points =
      nodes.empty() ? resample(entry.curve, segments) : cut_curve(entry.curve, segments, nodes);
  for (std::int64_t i = 0; i < entry.count.value_or(1); ++i) {
    const std::string name = entry.count ? entry.name + "_" + std::to_string(i) : entry.name;
    std::vector<Eigen::Vector3d> moved = points;
    for (Eigen::Vector3d& point : moved) {
      point += static_cast<double>(i) * entry.offset;
    }
    with_fiber_name(entry.name, [&] {
      with_context(entry.place, [&] {
        scene.rods.add(moved, entry.radius, entry.section);
        set_sections(entry, nodes, scene.rods);
        set_velocities(entry, scene.rods);
      });
    });
    if (entry.is_closed) {
      scene.rods.closed.resize(scene.rods.count(), 0);
      scene.rods.closed.back() = 1;
    }
    scene.fibers.push_back({name, entry.name, entry.place, entry.length, entry.angular_velocity,
                            nodes, entry.stiff_side});
    scene.fiber_names.push_back(name);
  }
}

}  // namespace

std::vector<FiberEntry> read_fibers(const YamlField& list, bool chooses_segments) {
  std::vector<FiberEntry> fibers;
  for (const YamlField& entry : list.items()) {
    fibers.push_back(read_fiber(entry, chooses_segments));
  }
  if (fibers.empty()) {
    list.refuse("a list of at least one fibre");
  }
  return fibers;
}

std::int64_t FiberEntry::segments_for(std::optional<double> accuracy) const {
  if (segments) {
    return *segments;
  }
  return with_fiber_name(name, [&] {
    const std::int64_t chosen =
        std::max<std::int64_t>(fiber::segments_for(accuracy.value(), turning, limpness),
                               is_closed ? min_closed_segments : 1);
    if (chosen > max_segments) {
      throw std::invalid_argument(place + ": the scene's accuracy takes " + std::to_string(chosen) +
                                  " segments, " + std::to_string(max_segments) + " are the most");
    }
    return chosen;
  });
}

void cut_fibers(const std::vector<FiberEntry>& entries, std::optional<double> accuracy,
                SimDescription& scene) {
  std::int64_t total = 0;
  for (const FiberEntry& entry : entries) {
    const std::int64_t segments = entry.segments_for(accuracy);
    const std::int64_t count = entry.count.value_or(1);
    if (count > max_segments / segments) {
      throw std::invalid_argument(entry.repeat_place + ": " + std::to_string(count) +
                                  " fibres of " + std::to_string(segments) +
                                  " segments are too many, a scene has at most " +
                                  std::to_string(max_segments) + " segments");
    }
    total += count * segments;
    if (total > max_segments) {
      throw std::invalid_argument(entry.place + ": with this fibre the scene has " +
                                  std::to_string(total) + " segments, " +
                                  std::to_string(max_segments) + " are the most");
    }
    add(entry, segments, scene);
  }
  std::set<std::string> names;
  for (const SimFiber& fiber : scene.fibers) {
    if (!names.insert(fiber.name).second) {
      throw std::invalid_argument(fiber.place + " has the name " + quote(fiber.name) +
                                  " of another fibre of the scene");
    }
  }
  if (!scene.rods.closed.empty()) {
    scene.rods.closed.resize(scene.rods.count(), 0);
  }
}

}  // namespace fiber
