#include "fiber_proximity/sim/scene/prediction.hpp"

#include <cstddef>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "src/python/contacts.hpp"
#include "src/python/simulation.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/with_context.hpp"

namespace fiber::python {
namespace {

/// A trajectory of a dict, whose fibre has not been looked up yet.
struct Trajectory {
  std::pair<std::string, std::int64_t> fiber;
  std::int64_t node = -1;
  PlacementPath path;
  bool has_tangents = false;
  bool has_directors = false;
};

/// The value of a key, and that it has been read.
py::object take(py::dict& dict, const char* key) {
  if (!dict.contains(key)) {
    return py::none();
  }
  return dict.attr("pop")(key);
}

std::vector<Eigen::Vector3d> take_vectors(py::dict& dict, const char* key, std::size_t count,
                                          const Eigen::Vector3d& otherwise) {
  const py::object given = take(dict, key);
  if (given.is_none()) {
    return std::vector<Eigen::Vector3d>(count, otherwise);
  }
  std::vector<Eigen::Vector3d> vectors = to_points(given, key);
  if (vectors.size() != count) {
    throw std::invalid_argument("there are " + std::to_string(vectors.size()) + " " + key +
                                " for " + std::to_string(count) + " times");
  }
  return vectors;
}

Trajectory to_trajectory(const py::handle& object) {
  py::dict dict(py::reinterpret_borrow<py::dict>(object).attr("copy")());
  Trajectory trajectory;
  for (const char* key : {"fiber", "times", "positions"}) {
    if (!dict.contains(key)) {
      throw std::invalid_argument(std::string("it has no ") + key);
    }
  }
  trajectory.fiber = fiber_argument(take(dict, "fiber"));
  const py::object node = take(dict, "node");
  trajectory.node = node.is_none() ? -1 : node.cast<std::int64_t>();
  const std::vector<double> times = to_numbers(take(dict, "times"), "times");
  const auto positions = take_vectors(dict, "positions", times.size(), {});
  trajectory.has_tangents = dict.contains("tangents");
  trajectory.has_directors = dict.contains("directors");
  const auto tangents = take_vectors(dict, "tangents", times.size(), Eigen::Vector3d::UnitX());
  const auto directors = take_vectors(dict, "directors", times.size(), Eigen::Vector3d::UnitY());
  for (std::size_t i = 0; i < times.size(); ++i) {
    trajectory.path.emplace_back(times[i], Placement{positions[i], tangents[i], directors[i]});
  }
  if (!dict.empty()) {
    throw std::invalid_argument("there is no key " + std::string(py::repr(dict.begin()->first)) +
                                ", known are fiber, node, times, positions, tangents, directors");
  }
  return trajectory;
}

/// A trajectory without directions keeps those that its hold has.
HoldTrajectory hold_trajectory(const SimScene& scene, const Trajectory& asked) {
  const std::uint32_t rod = find_fiber(scene, asked.fiber.first, asked.fiber.second);
  const std::uint32_t node = find_node(scene, rod, asked.node).node;
  const Placement now = placement_now(scene, rod, node);
  HoldTrajectory trajectory{rod, node, asked.path};
  for (auto& [time, placement] : trajectory.path) {
    placement.tangent = asked.has_tangents ? placement.tangent : now.tangent;
    placement.director = asked.has_directors ? placement.director : now.director;
  }
  return trajectory;
}

/// @throws std::invalid_argument naming the trajectory
std::vector<Trajectory> to_trajectories(const py::list& list) {
  std::vector<Trajectory> trajectories;
  for (std::size_t i = 0; i < list.size(); ++i) {
    const py::object each = list[i];
    if (!py::isinstance<py::dict>(each)) {
      throw py::type_error("trajectory " + std::to_string(i) + " is " +
                           std::string(py::repr(each)) + ", it must be a dict");
    }
    with_context("trajectory " + std::to_string(i),
                 [&] { trajectories.push_back(to_trajectory(each)); });
  }
  return trajectories;
}

py::dtype touch_dtype() {
  const PredictedTouch touch{};
  const auto at = [&](auto member) { return offset_of(touch, member); };
  return make_dtype({{"fiber", "u4", at(&PredictedTouch::rod)},
                     {"is_object", "?", at(&PredictedTouch::is_object)},
                     {"other", "u4", at(&PredictedTouch::other)},
                     {"first", "f8", at(&PredictedTouch::first)},
                     {"last", "f8", at(&PredictedTouch::last)},
                     {"force", "f8", at(&PredictedTouch::max_force)},
                     {"time", "f8", at(&PredictedTouch::time_of_max)}},
                    sizeof(touch));
}

py::dtype greatest_force_dtype() {
  const GreatestForce force{};
  const auto at = [&](auto member) { return offset_of(force, member); };
  return make_dtype({{"fiber", "u4", at(&GreatestForce::rod)},
                     {"index", "u4", at(&GreatestForce::node)},
                     {"force", "f8", at(&GreatestForce::force)},
                     {"time", "f8", at(&GreatestForce::time)}},
                    sizeof(force));
}

py::dict to_dict(Prediction& told, std::size_t points) {
  std::vector<double> times;
  Doubles positions(std::vector<py::ssize_t>{static_cast<py::ssize_t>(told.samples.size()),
                                             static_cast<py::ssize_t>(points), 3});
  double* next = positions.mutable_data();
  for (const Prediction::Sample& sample : told.samples) {
    times.push_back(sample.time);
    for (const Eigen::Vector3d& position : sample.positions) {
      next = std::copy_n(position.data(), 3, next);
    }
  }
  std::vector<Contact> contacts;
  std::vector<double> contact_times;
  py::list are_objects;
  for (const PredictedClearance& clearance : told.clearances) {
    contacts.push_back(clearance.contact);
    contact_times.push_back(clearance.time);
    are_objects.append(clearance.is_object);
  }
  py::dict dict;
  dict["times"] = to_array(times);
  dict["positions"] = positions;
  dict["clearances"] = to_array(contact_dtype(), contacts);
  dict["clearance_times"] = to_array(contact_times);
  dict["clearance_is_object"] = py::array_t<bool>(are_objects);
  dict["touches"] = to_array(touch_dtype(), told.touches);
  dict["tensions"] = to_array(greatest_force_dtype(), told.tensions);
  dict["holds"] = to_array(greatest_force_dtype(), told.holds);
  dict["joints"] = to_array(greatest_force_dtype(), told.joints);
  py::list warnings;
  for (const PredictedWarning& warning : told.warnings) {
    warnings.append(py::make_tuple(warning.time, warning.text));
  }
  dict["warnings"] = warnings;
  dict["time"] = told.time;
  dict["problem"] = told.problem;
  dict["unbalanced_frames"] = told.unbalanced_frames;
  return dict;
}

}  // namespace

const char* const predict_doc = R"(
Where fibres will be, and what happens on the way, if what holds them moves as told: on a copy of
the scene, which goes on bit for bit as this one would.

Parameters
----------
duration : float [s]
    How far to look ahead, rounded up to whole frames; at most 3600.
trajectories : list of dict
    Each of a held node: ``fiber`` (name or index), ``node``, ``times`` (k,) [s] from now, rising,
    ``positions`` (k, 3) [m], and for clamps ``tangents`` and ``directors`` (k, 3) of unit length,
    across each other; without, a clamp keeps those that it has. In between it moves on straight
    lines, before the first of them from where it is.
sample_period : float [s]
    From one sample of the positions to the next; 0: only where they are in the end.
margin : float [m]
    Least distances up to this are told.

Returns
-------
dict
    ``times`` (k,) [s] and ``positions`` (k, n, 3) [m] of the samples; ``clearances``, the least
    distance of each pair of bodies, with ``clearance_times`` and ``clearance_is_object`` (whether
    fiber_b is an object); ``touches`` with the fields fiber, is_object, other, first, last, force
    (the greatest, all contacts together) and time; ``tensions``, ``holds`` and ``joints``, the
    greatest of each fibre, of each hold and of each joint on each of its nodes, with the fields
    fiber, index, force, time; ``warnings``, a list of (time, text): what goes wrong on the way, as
    a node that lags behind what holds it with all its force, the first of each kind; ``time`` [s], how far it came, and ``problem``,
    why no further; ``unbalanced_frames``.

Raises
------
ValueError
    Naming the trajectory, its entry and value, for what may not be asked.

>>> from fiber_proximity import Simulation
>>> simulation = Simulation({
...     "fibers": [{"name": "cable", "material": "power_cable", "radius": 0.005,
...                 "segments": 20, "shape": {"line": {"from": [0, 0, 1], "to": [0.5, 0, 1]}}}],
...     "effects": ["gravity", "stretch", "bend", "attachment"]})
>>> told = simulation.predict(0.5, [{"fiber": "cable", "node": 0, "times": [0.4],
...                                  "positions": [[0, 0, 1.2]]}])
>>> told["positions"].shape, simulation.time
((1, 21, 3), 0.0)
)";

py::dict predict(const Simulation& simulation, double duration, const py::list& trajectories,
                 double sample_period, double margin) {
  const std::vector<Trajectory> asked = to_trajectories(trajectories);
  SimScene scene = simulation.copy();
  Prediction told;
  {
    const WithoutPythonLock others_may_run;
    std::vector<HoldTrajectory> holds;
    for (std::size_t i = 0; i < asked.size(); ++i) {
      with_context("trajectory " + std::to_string(i),
                   [&] { holds.push_back(hold_trajectory(scene, asked[i])); });
    }
    follow(scene, holds);
    PredictionOptions options;
    options.duration = duration;
    options.sample_period = sample_period;
    options.margin = margin;
    told = fiber::predict(scene, options);
  }
  return to_dict(told, scene.stepper->rods().positions.size());
}

}  // namespace fiber::python
