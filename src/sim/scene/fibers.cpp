#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "fiber_proximity/sim/resolution.hpp"
#include "src/sim/scene/keys.hpp"
#include "src/sim/scene/parts.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

/// The number of segments in which the turning of a curve is measured.
constexpr std::int64_t fine_segments = 1000;

/// The accuracies that real_time chooses from, the finest first.
constexpr std::array<double, 8> accuracies{0.001, 0.002, 0.005, 0.01, 0.02, 0.05, 0.1, 0.2};

/// The part of the time for steps: the rest is for messages, and for whatever else runs.
constexpr double share_of_time = 0.5;

/// A fibre of a scene before it is cut into segments, or several of them by `repeat`.
struct FiberEntry {
  std::string name;
  std::string place;                   ///< where it stands, for errors
  std::vector<Eigen::Vector3d> curve;  ///< a polyline [m]
  std::optional<std::int64_t> segments;
  double radius = 0.0;  ///< [m]
  RodSection section;
  std::optional<std::int64_t> count;  ///< none: it is not repeated
  std::string repeat_place;
  std::string material_defaults;  ///< values that its material leaves open; empty for none
  Eigen::Vector3d offset = Eigen::Vector3d::Zero();  ///< of each from the one before [m]

  // Only known where segments are chosen.
  double length = 0.0;   ///< of the curve [m]
  double turning = 0.0;  ///< of the curve in all [rad]

  /// The segments given, or chosen for an accuracy.
  std::int64_t segments_for(std::optional<double> accuracy) const {
    if (segments) {
      return *segments;
    }
    return with_fiber_name(name, [&] {
      const std::int64_t chosen = fiber::segments_for(accuracy.value(), turning);
      if (chosen > max_segments) {
        throw std::invalid_argument(place + ": the scene's accuracy takes " +
                                    std::to_string(chosen) + " segments, " +
                                    std::to_string(max_segments) + " are the most");
      }
      return chosen;
    });
  }
};

RodMaterial read_preset(const YamlField& field) {
  return with_context(field.place(), [&] { return material_preset(field.text()); });
}

/// A preset's name, or the moduli and so on; with both, these replace the preset's.
/// @param defaults the values that neither of them gives, and what is taken
RodMaterial read_material(const YamlField& field, std::string& defaults) {
  if (field.is_text()) {
    return read_preset(field);
  }
  field.require_map(key_names("material"));
  const auto preset = field.find("preset");
  RodMaterial material = preset ? read_preset(*preset) : RodMaterial();
  const auto read = [&](const char* key, double& value, const char* unit) {
    if (!preset && !field.find(key)) {
      defaults += format(defaults.empty() ? "" : ", ", key, " ", value, unit);
    }
    field.read(key, value);
  };
  read("youngs_modulus", material.youngs_modulus, " Pa");
  read("shear_modulus", material.shear_modulus, " Pa");
  read("density", material.density, " kg/m^3");
  read("bending_share", material.bending_share, "");
  return material;
}

void measure(FiberEntry& fiber) {
  for (std::size_t i = 1; i < fiber.curve.size(); ++i) {
    fiber.length += (fiber.curve[i] - fiber.curve[i - 1]).norm();
  }
  const std::vector<Eigen::Vector3d> points = resample(fiber.curve, fine_segments);
  for (std::size_t i = 2; i < points.size(); ++i) {
    const Eigen::Vector3d before = points[i - 1] - points[i - 2];
    const Eigen::Vector3d after = points[i] - points[i - 1];
    fiber.turning += std::atan2(before.cross(after).norm(), before.dot(after));
  }
}

void read_body(const YamlField& entry, bool chooses_segments, FiberEntry& fiber) {
  if (!chooses_segments || entry.find("segments")) {
    fiber.segments = entry.get("segments").integer(1, max_segments);
  }
  fiber.curve = read_shape(entry.get("shape"));
  if (chooses_segments) {
    measure(fiber);
  }
  fiber.radius = entry.get("radius").number();
  const YamlField given = entry.get("material");
  const RodMaterial material = read_material(given, fiber.material_defaults);
  fiber.section =
      with_context(given.place(), [&] { return solid_round_section(material, fiber.radius); });
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
  const std::vector<Eigen::Vector3d> points = resample(entry.curve, segments);
  for (std::int64_t i = 0; i < entry.count.value_or(1); ++i) {
    const std::string name = entry.count ? entry.name + "_" + std::to_string(i) : entry.name;
    std::vector<Eigen::Vector3d> moved = points;
    for (Eigen::Vector3d& point : moved) {
      point += static_cast<double>(i) * entry.offset;
    }
    with_fiber_name(entry.name, [&] {
      with_context(entry.place, [&] { scene.rods.add(moved, entry.radius, entry.section); });
    });
    scene.fibers.push_back({name, entry.name, entry.place});
    scene.fiber_names.push_back(name);
  }
}

/// Cuts the fibres into segments: the rods of a scene, and what they are called.
void cut(const std::vector<FiberEntry>& entries, SimDescription& scene) {
  std::int64_t total = 0;
  for (const FiberEntry& entry : entries) {
    const std::int64_t segments = entry.segments_for(scene.accuracy);
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
}

double read_accuracy(const YamlField& field) {
  constexpr const char* allowed = "above 0 and at most 0.5, or 50 %";
  std::string text = field.text();
  const bool is_percent = !text.empty() && text.back() == '%';
  if (is_percent) {
    text.pop_back();
  }
  std::size_t used = 0;
  double value = 0.0;
  try {
    value = std::stod(text, &used);
  } catch (const std::exception&) {
    field.refuse(allowed);
  }
  used = std::min(text.size(), text.find_first_not_of(' ', used));
  value *= is_percent ? 0.01 : 1.0;
  if (used != text.size() || !(value > 0.0 && value <= 0.5)) {
    field.refuse(allowed);
  }
  return value;
}

std::uint32_t chosen_substeps(const std::vector<FiberEntry>& fibers, double gravity,
                              const SimSettings& scene) {
  double period = std::numeric_limits<double>::infinity();
  for (const FiberEntry& fiber : fibers) {
    if (fiber.length > 0.0) {  // or it is refused when it is cut
      period = std::min(period, swing_period(fiber.section, fiber.length, gravity));
    }
  }
  return substeps_for(*scene.accuracy, scene.options.integrator, scene.time_step, period);
}

bool is_fast(const std::vector<FiberEntry>& fibers, const SimSettings& scene) {
  std::uint64_t nodes = 0;
  for (const FiberEntry& fiber : fibers) {
    nodes += (fiber.segments_for(scene.accuracy) + 1) * fiber.count.value_or(1);
  }
  // Most steps take so many iterations; a scene that says how many they may take knows better.
  constexpr std::uint32_t usual_iterations = 2;
  const std::uint32_t iterations = std::min(usual_iterations, scene.options.max_iterations);
  return frame_time(nodes, scene.substeps, iterations, scene.has_contacts) <=
         share_of_time * scene.time_step;
}

}  // namespace

void read_fibers(const YamlField& document, double gravity, SimDescription& scene) {
  const auto accuracy = document.find("accuracy");
  const auto real_time = document.find("real_time");
  const auto given = document.find("substeps");
  const bool is_real_time = real_time && real_time->flag();
  if (accuracy && is_real_time) {
    real_time->refuse("absent or false where there is an accuracy");
  }
  if (given) {
    scene.substeps = static_cast<std::uint32_t>(given->integer(1, max_substeps));
  }
  const YamlField list = document.get("fibers");
  std::vector<FiberEntry> fibers;
  for (const YamlField& entry : list.items()) {
    fibers.push_back(read_fiber(entry, accuracy || is_real_time));
  }
  if (fibers.empty()) {
    list.refuse("a list of at least one fibre");
  }
  const auto choose = [&](double chosen) {
    scene.accuracy = chosen;
    scene.substeps = given ? scene.substeps : chosen_substeps(fibers, gravity, scene);
  };
  if (accuracy) {
    choose(read_accuracy(*accuracy));
  } else if (is_real_time) {
    for (const double candidate : accuracies) {
      choose(candidate);
      scene.substeps = std::min(scene.substeps, max_substeps);
      if (is_fast(fibers, scene)) {
        break;
      }
    }
  }
  cut(fibers, scene);
  if (scene.substeps > max_substeps) {
    accuracy->refuse("coarser: it takes " + std::to_string(scene.substeps) + " substeps a frame, " +
                     std::to_string(max_substeps) +
                     " are the most; bdf2 takes fewer, and `substeps` in the scene "
                     "are not chosen");
  }
}

}  // namespace fiber
