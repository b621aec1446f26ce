#include "src/sim/scene/keys.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>

#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/text/join.hpp"

namespace fiber {
namespace {

constexpr const char* needed = "required";
constexpr const char* three_numbers = "three numbers";
constexpr const char* a_direction = "three numbers, a direction";
constexpr double unlimited = std::numeric_limits<double>::infinity();

constexpr KeyLimits above_0{0.0, unlimited, true, false};
constexpr KeyLimits at_least_0{0.0, unlimited, false, false};
constexpr KeyLimits from_0_to_1{0.0, 1.0, false, false};

std::string text_of(double value) {
  std::ostringstream text;
  text << value;
  return text.str();
}

SceneKey other_key(const char* name, const std::string& allowed, const std::string& by_default,
                   const char* unit, const char* text) {
  return {name, allowed, by_default, unit, text, {}, std::nullopt};
}

SceneKey number_key(const char* name, const KeyLimits& limits, const std::string& by_default,
                    const char* unit, const char* text) {
  return {name,       (limits.excludes_min ? "a number " : "a number of ") + limits.text(),
          by_default, unit,
          text,       {},
          limits};
}

SceneKey number_key(const char* name, const KeyLimits& limits, double by_default, const char* unit,
                    const char* text) {
  SceneKey key = number_key(name, limits, text_of(by_default), unit, text);
  key.numbers = {by_default};
  return key;
}

SceneKey count_key(const char* name, double max, const std::string& by_default, const char* text) {
  std::ostringstream allowed;
  allowed << "a whole number from 1 to " << static_cast<std::int64_t>(max);
  return {name, allowed.str(), by_default, "", text, {}, KeyLimits{1.0, max, false, false}};
}

SceneKey vector_key(const char* name, const std::vector<double>& by_default, const char* unit,
                    const char* text) {
  std::vector<std::string> numbers;
  for (const double each : by_default) {
    numbers.push_back(text_of(each));
  }
  return {name, three_numbers, "[" + join(numbers) + "]", unit, text, by_default, std::nullopt};
}

/// A timer calls for frames, which needs some time itself: none may be shorter than a microsecond.
/// Smaller residuals than those allowed are rounding errors, and with larger ones nothing would
/// ever move.
SceneMap settings_map() {
  const SimSettings by_default;
  return {
      "scene",
      "The file itself.",
      false,
      {other_key("frame_id", "a string", by_default.frame_id, "", "the frame of all points"),
       number_key("time_step", {1e-6, 1000.0, false, false}, text_of(by_default.time_step), "s",
                  "from frame to frame"),
       count_key("substeps", max_substeps, text_of(by_default.substeps),
                 "steps of a frame; chosen where there is `accuracy` or `real_time`"),
       count_key("iterations", max_iterations, text_of(by_default.options.max_iterations),
                 "of Newton's method in a step, at most"),
       number_key("residual", {1e-9, 1.0, false, false}, text_of(by_default.options.residual),
                  "m/s", "to which forces balance in a step"),
       other_key("integrator", "`implicit_euler` or `bdf2`", "implicit_euler", "",
                 "of first order, which damps; or of second order, which keeps swings"),
       other_key("accuracy", "a number above 0 and at most 0.5, or 50 %", "", "",
                 "chooses the fewest segments and substeps that are as accurate as that"),
       other_key("real_time", "true or false", "false", "",
                 "chooses the most accurate segments and substeps that are computed in time; not "
                 "beside `accuracy`"),
       other_key("fibers", "a list of at least one fibre", needed, "", "see below"),
       other_key("effects", "a list of effects, each at most once", needed, "", "see below"),
       other_key("environment", "a map of `obstacles` and `allowed`", "", "",
                 "what is around the fibres, as in the node's `~scene` "
                 "([environment.md](environment.md)); nothing in it moves"),
       other_key("initial_overlap", "`refuse` or `separate`", "refuse", "",
                 "what is done with fibres that begin inside of something"),
       number_key("max_strain", {0.0, 10.0, true, false}, text_of(by_default.max_strain), "",
                  "by which ~attach, handles and tf frames stretch fibres at most")}};
}

std::vector<SceneMap> fiber_maps() {
  const RodMaterial by_default;
  return {
      {"fiber",
       "An entry of `fibers`.",
       false,
       {other_key("name", "a string", needed, "", "unlike that of any other fibre"),
        other_key("shape", "a map of one shape", needed, "", "in which it begins; see below"),
        count_key("segments", max_segments, needed,
                  "of equal length; the fibres of a scene have no more than these together. Chosen "
                  "where it is absent and there is `accuracy` or `real_time`"),
        number_key("radius", above_0, needed, "m", "the same all along the fibre"),
        other_key("material", "a preset, or a map of moduli", needed, "", "see below"),
        other_key("repeat", "a map of `count` and `offset`", "", "",
                  "the entry is several fibres")}},
      {"repeat",
       "The key `repeat` of a fibre: fibres `NAME_0`, `NAME_1`, and so on.",
       false,
       {count_key("count", max_repeats, needed, "of the fibres"),
        other_key("offset", three_numbers, needed, "m", "of each from the one before")}},
      {"material",
       "The key `material` of a fibre: a preset's name (" + join(material_names()) +
           "), or these. Beside a preset they replace what it gives.",
       false,
       {other_key("preset", "one of " + join(material_names()), "", "", "orders of magnitude"),
        number_key("youngs_modulus", above_0, text_of(by_default.youngs_modulus), "Pa", "E"),
        number_key("shear_modulus", above_0, text_of(by_default.shear_modulus), "Pa", "G"),
        number_key("density", above_0, text_of(by_default.density), "kg/m³", ""),
        number_key("bending_share", {0.0, 1.0, true, false}, text_of(by_default.bending_share), "",
                   "part of a solid rod's bending stiffness that sliding strands leave")}}};
}

std::vector<SceneMap> shape_maps() {
  const SceneKey from = other_key("from", three_numbers, needed, "m", "where it begins");
  const SceneKey to = other_key("to", three_numbers, needed, "m", "where it ends");
  const SceneKey center = other_key("center", three_numbers, needed, "m", "");
  return {
      {"shape line", "A straight line.", false, {from, to}},
      {"shape arc",
       "An arc of a circle.",
       false,
       {from, to,
        number_key("length", above_0, needed, "m",
                   "longer than the straight way, and less than a thousand times that"),
        other_key("towards", a_direction, "[0, 0, -1]", "", "to which side it sags")}},
      {"shape helix",
       "A helix about z, from the centre upwards.",
       false,
       {center, number_key("radius", above_0, needed, "m", ""),
        other_key("pitch", "a number", needed, "m", "how much a turn rises"),
        number_key("turns", above_0, needed, "", "")}},
      {"shape polyline",
       "A list of at least two points [m], of which no two that follow each other are the same.",
       false,
       {}},
      {"shape trefoil",
       "An overhand knot, its ends up and apart along x.",
       false,
       {center, number_key("size", above_0, needed, "m", "its width")}}};
}

SceneMap contact_map(const char* name, const char* about) {
  return {
      name,
      about,
      true,
      {number_key("stiffness", at_least_0, 0.0, "N/m",
                  "force by distance where surfaces meet; 0: by the material"),
       number_key("restitution", from_0_to_1, default_restitution, "",
                  "part of the speed of their approach with which surfaces part after an impact")}};
}

SceneMap drag_map() {
  const Drag::Options by_default;
  const WindField& wind = by_default.wind;
  const auto numbers = [](const Eigen::Vector3d& v) {
    return std::vector<double>(v.data(), v.data() + 3);
  };
  return {
      "drag",
      "The air, or another fluid that stands still or blows, resists.",
      true,
      {number_key("fluid_density", at_least_0, by_default.fluid_density, "kg/m³", ""),
       number_key("across", at_least_0, by_default.across, "", "coefficient in cross flow"),
       number_key("along", at_least_0, by_default.along, "", "coefficient along the fibre"),
       vector_key("wind.mean", numbers(wind.mean), "m/s", "velocity"),
       vector_key("wind.gust", numbers(wind.gust), "m/s", "amplitude of gusts"),
       number_key("wind.gust_period", above_0, wind.gust_period, "s", ""),
       number_key("wind.gust_length", above_0, wind.gust_length, "m", "along the mean velocity")}};
}

SceneMap bend_map() {
  return {
      "bend",
      "EI resists bending.",
      true,
      {other_key("natural_curvature", "a number of at least 0, or `from_shape`", "0", "1/m",
                 "at which it rests; `from_shape`: that in which each fibre begins"),
       other_key("towards", a_direction, "", "",
                 "to which side the first edge of each fibre bends; only with `twist` and a number "
                 "for `natural_curvature`")}};
}

std::vector<SceneMap> attachment_maps() {
  return {
      {"attachment",
       "Its options are a list of holds, each of these keys. No node is held twice.",
       true,
       {other_key("fiber", "the name of a fibre", needed, "",
                  "that of a repeated one means each of its fibres"),
        other_key("node", "`first`, `last` or an index", "first", "", ""),
        other_key("kind", "`pin` or `clamp`", "pin", "", "a clamp holds the direction, too"),
        other_key(
            "position", three_numbers, "", "m",
            "within an edge's length of the node; where it is if it is absent. With `frame`, in "
            "that frame, and its origin if it is absent"),
        other_key("tangent", a_direction, "", "", "of a clamp; the fibre's own if it is absent"),
        other_key("director", "three numbers, a direction across the tangent", "", "",
                  "of a clamp with `twist`: how the section lies; its own if it is absent"),
        other_key("path", "a list of waypoints", "", "", "on which it moves; see below"),
        number_key(
            "period", above_0, "", "s",
            "after which the path begins again; longer than the path, to whose beginning it leads"),
        other_key("frame", "a string", "", "", "of tf, which it follows; not beside `path`"),
        number_key(
            "max_force", above_0, "", "N",
            "with which it pulls at most; if it is absent, what stretches the fibre by a tenth")}},
      {"waypoint",
       "An entry of `path`. In between, holds move in a straight line. What is not given stays as "
       "it was.",
       false,
       {other_key("time", "a number, 0 in the first and then rising", needed, "s", ""),
        other_key("position", three_numbers, "", "m", ""),
        other_key("tangent", a_direction, "", "", ""),
        other_key("director", "three numbers, a direction across the tangent", "", "", "")}}};
}

std::vector<SceneMap> effect_maps() {
  const Friction::Options friction;
  const Plasticity::Options plasticity;
  std::vector<SceneMap> maps{
      {"gravity", "", true, {vector_key("acceleration", {0.0, 0.0, -9.81}, "m/s²", "")}},
      {"stretch", "EA resists changes of length.", true, {}},
      {"inextensible", "In place of `stretch`: lengths stay.", true, {}},
      bend_map(),
      {"twist",
       "GJ resists twist, and clamps hold the section, too. Friction acts at the surface, so that "
       "fibres roll.",
       true,
       {}},
      {"damping",
       "Of stretch, bend and twist. Rigid motion is never damped.",
       true,
       {number_key("relaxation_time", at_least_0, 0.01, "s", "")}},
      drag_map(),
      {"plasticity",
       "Bending that stays. Not beside a natural curvature that has a direction.",
       true,
       {number_key("yield_strain", above_0, plasticity.yield_strain, "", "of the outermost layer"),
        number_key("hardening", {0.0, 1.0, false, true}, plasticity.hardening, "",
                   "elastic part of what is bent beyond that")}},
      contact_map("self_contact", "A fibre touches itself."),
      contact_map("fiber_contact", "Fibres touch each other."),
      contact_map("environment_contact", "Fibres touch the obstacles of `environment`."),
      {"friction",
       "In all contacts, of which the scene must name some. Without `twist` it acts on the axes: "
       "fibres slide, and never roll.",
       true,
       {number_key("coefficient", at_least_0, friction.coefficient, "", ""),
        number_key("stick_speed", above_0, friction.stick_speed, "m/s",
                   "over a step, the length by which what sticks gives way before it slides")}}};
  for (SceneMap& map : attachment_maps()) {
    maps.push_back(std::move(map));
  }
  return maps;
}

}  // namespace

bool KeyLimits::contain(double value) const {
  return std::isfinite(value) && (excludes_min ? value > min : value >= min) &&
         (excludes_max ? value < max : value <= max);
}

std::string KeyLimits::text() const {
  std::ostringstream text;
  text << (excludes_min ? "above " : "at least ") << min;
  if (std::isfinite(max)) {
    text << " and " << (excludes_max ? "below " : "at most ") << max;
  }
  return text.str();
}

const std::vector<SceneMap>& scene_maps() {
  static const std::vector<SceneMap> maps = [] {
    std::vector<SceneMap> all{settings_map()};
    for (const auto& some : {fiber_maps(), shape_maps(), effect_maps()}) {
      all.insert(all.end(), some.begin(), some.end());
    }
    return all;
  }();
  return maps;
}

const std::vector<SceneKey>& keys_of_scene_map(const std::string& name) {
  const std::vector<SceneMap>& maps = scene_maps();
  const auto found = std::find_if(maps.begin(), maps.end(),
                                  [&name](const SceneMap& map) { return map.name == name; });
  assert(found != maps.end());
  return found->keys;
}

std::vector<std::string> key_names(const std::string& map) {
  std::vector<std::string> names;
  for (const SceneKey& key : keys_of_scene_map(map)) {
    names.push_back(key.name);
  }
  return names;
}

const KeyLimits& key_limits(const std::string& map, const std::string& key) {
  const std::vector<SceneKey>& keys = keys_of_scene_map(map);
  const auto found = std::find_if(keys.begin(), keys.end(),
                                  [&key](const SceneKey& each) { return each.name == key; });
  assert(found != keys.end());
  return found->limits.value();
}

}  // namespace fiber
