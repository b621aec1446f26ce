#include "src/sim/scene/keys.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <sstream>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/sim/scene/key_entries.hpp"

namespace fiber {
namespace {

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
       count_key("iterations", max_step_iterations, text_of(by_default.options.max_iterations),
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
                 "([environment.md](environment.md)); those with a `motion` move"),
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
        number_key("radius", above_0, needed, "m", "of all of it but sections that have their own"),
        other_key("material", "a preset, or a map of moduli", needed, "", "see below"),
        other_key("stiff_towards", three_numbers, "", "",
                  "the side of its first segment to which materials with a `bending_ratio` are "
                  "stiffer; needed where there is one above 1, and only then. Takes the effects "
                  "`bend` and `twist`"),
        other_key("closed", "true or false", "false", "",
                  "its last segment leads back to where it begins; of three segments at least. Its "
                  "last node is the one before it is at its first one again"),
        other_key("repeat", "a map of `count` and `offset`", "", "", "the entry is several fibres"),
        other_key("velocity", three_numbers, "[0, 0, 0]", "m/s",
                  "with which all of it begins; no point may begin faster than 1000 m/s"),
        other_key("velocities", "a list of at least two velocities", "", "m/s",
                  "in place of `velocity`: of points at equal distances along the fibre from its "
                  "first end to its last, in between straight lines"),
        other_key("angular_velocity", three_numbers, "[0, 0, 0]", "rad/s",
                  "about its own centre of mass, without that of loads, to begin with; added to "
                  "the above"),
        other_key("sections", "a list of parts of its length", "", "",
                  "that have materials or radii of their own, or are rigid; see below")}},
      {"section",
       "An entry of the list `sections` of a fibre, one behind the other. Those with a radius of "
       "their own and rigid ones begin and end at nodes.",
       false,
       {number_key("from", at_least_0, "", "m",
                   "along the fibre, where it begins: not before the end of the section before; 0 "
                   "if it is absent"),
        number_key("to", above_0, "", "m",
                   "along the fibre, where it ends: the fibre's length at most, and that if it is "
                   "absent"),
        other_key("material", "a preset, or a map of moduli", "", "",
                  "as that of a fibre; values that a map without a preset leaves open are the "
                  "fibre's. Needed where there is neither a radius nor `rigid`"),
        number_key("radius", above_0, "", "m",
                   "for contacts, stiffness and mass; the fibre's if absent"),
        other_key("rigid", "true or false", "false", "",
                  "it neither bends nor twists: a plug. It is one segment of its length, straight, "
                  "where the shape turns by about 9 degrees at most, and gives way to tension by "
                  "its material")}},
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
                   "part of a solid rod's bending stiffness that sliding strands leave"),
        number_key(
            "bending_ratio", {1.0, unlimited, false, false}, text_of(by_default.bending_ratio), "",
            "how many times as stiff it is when it bends to `stiff_towards` as when it bends "
            "across that: a flat cable")}}};
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

std::vector<SceneMap> obstacle_maps() {
  return {
      {"obstacle link",
       "An obstacle of `environment` that is a link of a robot, for cable_sim: its shapes are the "
       "link's collision geometry, and it moves as the link's frame of tf does.",
       false,
       {other_key("link", "a string", needed, "", "its name, in the URDF and in tf"),
        other_key("id", "a string", "the link's name", "", "the obstacle's name"),
        other_key("robot_description", "the name of a parameter", "robot_description", "",
                  "where the URDF is")}},
      {"obstacle motion",
       "The key `motion` of an obstacle of `environment`. Fibres give way to it; where they "
       "cannot, "
       "it stays behind.",
       false,
       {other_key(
            "path", "a list of at least one entry", "", "",
            "where it goes, in place of `frame`; see below. No point of it may be faster than "
            "1000 m/s"),
        other_key("period", "a number above the last time", "", "s",
                  "after which the path begins again, to where it leads back from its last entry"),
        other_key("axis", a_direction, "[0, 0, 1]", "",
                  "about which `angle` turns it, in its own frame"),
        other_key("frame", "a string", "", "",
                  "of tf, that carries it: `pose` is in this frame; for cable_sim")}},
      {"obstacle waypoint",
       "An entry of the list `path` of a motion. What is not given stays as it was, to begin with "
       "as "
       "the obstacle's `pose` has it; in between straight lines, and turns at constant rates.",
       false,
       {other_key("time", "a number above the time before", needed, "s", "0 for the first one"),
        other_key("position", three_numbers, "", "m", "of its origin"),
        other_key("orientation", "four numbers, a quaternion x y z w", "", "",
                  "it turns the shorter way round"),
        other_key("angle", "a number", "0", "rad",
                  "by which it is turned beyond that, about `axis`: a drum winds by many turns")}}};
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
    for (const auto& some : {fiber_maps(), shape_maps(), obstacle_maps(), effect_maps()}) {
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
