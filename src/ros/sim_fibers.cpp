#include "fiber_proximity/ros/sim_fibers.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <set>
#include <stdexcept>

#include "fiber_proximity/ros/naming.hpp"
#include "fiber_proximity/ros/sim_shapes.hpp"
#include "fiber_proximity/sim/resolution.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

constexpr std::int64_t most_segments = 1000000;  // of all fibres together, too
constexpr std::int64_t most_repeats = 100000;

/// A preset's name, or the moduli and so on; with both, these replace the preset's.
fiber::RodMaterial read_material(const YamlField& field, bool is_name) {
  if (is_name) {
    return naming(field.place(), [&] { return fiber::material_preset(field.text()); });
  }
  field.require_map({"preset", "youngs_modulus", "shear_modulus", "density", "bending_share"});
  fiber::RodMaterial material;
  if (const auto preset = field.find("preset")) {
    material = read_material(*preset, true);
  }
  const auto read = [&field](const char* key, double& value) {
    if (const auto given = field.find(key)) {
      value = given->number();
    }
  };
  read("youngs_modulus", material.youngs_modulus);
  read("shear_modulus", material.shear_modulus);
  read("density", material.density);
  read("bending_share", material.bending_share);
  return material;
}

/// By how much a curve turns in all [rad].
double turning_of(const std::vector<Eigen::Vector3d>& points) {
  double turning = 0.0;
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Eigen::Vector3d before = points[i - 1] - points[i - 2];
    const Eigen::Vector3d after = points[i] - points[i - 1];
    turning += std::atan2(before.cross(after).norm(), before.dot(after));
  }
  return turning;
}

std::int64_t read_segments(const YamlField& entry, std::optional<double> accuracy) {
  if (!accuracy || entry.find("segments")) {
    return entry.get("segments").integer(1, most_segments);
  }
  constexpr std::int64_t fine = 1000;
  const std::int64_t segments =
      fiber::segments_for(*accuracy, turning_of(read_sim_shape(entry.get("shape"), fine)));
  if (segments > most_segments) {
    throw std::invalid_argument(entry.place() + ": the scene's accuracy takes " +
                                std::to_string(segments) + " segments, " +
                                std::to_string(most_segments) + " are the most");
  }
  return segments;
}

void read_body(const YamlField& entry, std::optional<double> accuracy, SimFiber& fiber) {
  fiber.points = read_sim_shape(entry.get("shape"), read_segments(entry, accuracy));
  fiber.radius = entry.get("radius").number();
  const YamlField given = entry.get("material");
  const fiber::RodMaterial material = read_material(given, given.is_text());
  naming(given.place(),
         [&] { fiber.section = fiber::solid_round_section(material, fiber.radius); });
  // What the rods refuse is refused here, where the fibre has a name and a line.
  naming(entry.place(), [&] { fiber::Rods().add(fiber.points, fiber.radius, fiber.section); });
}

SimFiber read_fiber(const YamlField& entry, std::optional<double> accuracy) {
  entry.require_map({"name", "shape", "segments", "radius", "material", "repeat"});
  SimFiber fiber;
  fiber.name = entry.get("name").text();
  fiber.group = fiber.name;
  fiber.place = entry.place();
  naming_fiber(fiber.name, [&] { read_body(entry, accuracy, fiber); });
  return fiber;
}

/// The fibre, or as many as it is to be repeated, each moved by the offset from the one before.
std::vector<SimFiber> repeat(const SimFiber& fiber, const YamlField& entry) {
  const auto repeat = entry.find("repeat");
  if (!repeat) {
    return {fiber};
  }
  repeat->require_map({"count", "offset"});
  const std::int64_t count = repeat->get("count").integer(1, most_repeats);
  const auto segments = static_cast<std::int64_t>(fiber.points.size()) - 1;
  if (count > most_segments / segments) {
    throw std::invalid_argument(repeat->place() + ": " + std::to_string(count) + " fibres of " +
                                std::to_string(segments) +
                                " segments are too many, a scene has at "
                                "most " +
                                std::to_string(most_segments) + " segments");
  }
  const Eigen::Vector3d offset = repeat->get("offset").vector();
  std::vector<SimFiber> fibers(static_cast<std::size_t>(count), fiber);
  for (std::size_t i = 0; i < fibers.size(); ++i) {
    fibers[i].name += "_" + std::to_string(i);
    for (Eigen::Vector3d& point : fibers[i].points) {
      point += static_cast<double>(i) * offset;
    }
  }
  return fibers;
}

}  // namespace

std::vector<SimFiber> read_sim_fibers(const YamlField& list, std::optional<double> accuracy) {
  std::vector<SimFiber> fibers;
  std::set<std::string> names;
  std::size_t segments = 0;
  for (const YamlField& entry : list.items()) {
    for (SimFiber& fiber : repeat(read_fiber(entry, accuracy), entry)) {
      if (!names.insert(fiber.name).second) {
        throw std::invalid_argument(entry.place() + " has the name " + fiber::quote(fiber.name) +
                                    " of another fibre of the scene");
      }
      segments += fiber.points.size() - 1;
      fibers.push_back(std::move(fiber));
    }
    if (segments > static_cast<std::size_t>(most_segments)) {
      throw std::invalid_argument(entry.place() + ": with this fibre the scene has " +
                                  std::to_string(segments) + " segments, " +
                                  std::to_string(most_segments) + " are the most");
    }
  }
  if (fibers.empty()) {
    list.refuse("a list of at least one fibre");
  }
  return fibers;
}

}  // namespace fiber_proximity_ros
