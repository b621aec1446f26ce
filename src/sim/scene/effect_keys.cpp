// The keys of effects.
#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/effects.hpp"
#include "src/sim/scene/key_entries.hpp"

namespace fiber {
namespace {

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

std::vector<SceneMap> joint_maps() {
  return {
      {"joint",
       "What is joined is one place. Its options are a list of joints, each of these keys. No node "
       "is in two of them.",
       true,
       {other_key("kind", "`ball` or `weld`", "ball", "",
                  "a weld keeps the angles between the edges that meet there, and with `twist` how "
                  "they are turned; it takes `bend`"),
        other_key(
            "nodes", "a list of at least two nodes", needed, "",
            "see below; they begin within the largest radius there of the first one, to which "
            "they are moved")}},
      {"joint node",
       "An entry of a joint's `nodes`.",
       false,
       {other_key("fiber", "the name of a fibre", needed, "",
                  "that of one repeated n times means n joints; all nodes of a joint are then of "
                  "fibres repeated n times"),
        other_key("node", "`first`, `last` or an index", "first", "", ""),
        number_key("at", from_0_to_1, "", "",
                   "in place of `node`: a share of the fibre's length, at which it then has a node "
                   "however many segments it has")}}};
}

SceneKey table_key() {
  return other_key("table", "a list of entries", "", "", "how it changes in time; see below");
}

SceneKey period_key() {
  return number_key("period", above_0, "", "s",
                    "after which the table begins again; longer than the table, to whose beginning "
                    "it leads");
}

std::vector<SceneMap> load_maps() {
  return {
      {"load",
       "Forces, moments and weights. Its options are a list of loads, each of these keys, at a "
       "node or along a part of a fibre, over which they are spread evenly.",
       true,
       {other_key("fiber", "the name of a fibre", needed, "",
                  "that of a repeated one means each of its fibres"),
        other_key("node", "`first`, `last` or an index", "", "", "not beside `from` and `to`"),
        number_key("from", at_least_0, "", "m",
                   "along the fibre, where the part begins: below `to`, and 0 if it is absent"),
        number_key("to", above_0, "", "m",
                   "along the fibre, where the part ends: its length at most, and that if it is "
                   "absent"),
        other_key("force", three_numbers, "[0, 0, 0]", "N",
                  "in the scene's frame; along a part in N/m"),
        other_key("moment", three_numbers, "[0, 0, 0]", "N m",
                  "in the scene's frame; at the first or last node, whose edge it turns. Without "
                  "`twist` its part along the edge has nothing to act on"),
        other_key("torque", "a number", "0", "N m",
                  "about the fibre's direction; only with `twist`; along a part in N m/m"),
        number_key("mass", at_least_0, "0", "kg",
                   "of a weight, which adds to the fibre's inertia; along a part in kg/m"),
        table_key(), period_key()}},
      {"table",
       "An entry of `table`, of `gravity` or of a load. In between, values change in a straight "
       "line. What is not given stays as it was.",
       false,
       {other_key("time", "a number, 0 in the first and then rising", needed, "s", ""),
        other_key("acceleration", three_numbers, "", "m/s²", "of `gravity`"),
        other_key("force", three_numbers, "", "N", "of a load"),
        other_key("moment", three_numbers, "", "N m", "of a load"),
        other_key("torque", "a number", "", "N m", "of a load")}}};
}

}  // namespace

std::vector<SceneMap> effect_maps() {
  const Friction::Options friction;
  const Plasticity::Options plasticity;
  std::vector<SceneMap> maps{
      {"gravity",
       "",
       true,
       {vector_key("acceleration", {0.0, 0.0, -9.81}, "m/s²", ""), table_key(), period_key()}},
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
  for (const auto& some : {attachment_maps(), joint_maps(), load_maps()}) {
    maps.insert(maps.end(), some.begin(), some.end());
  }
  return maps;
}

}  // namespace fiber
