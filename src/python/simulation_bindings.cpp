#include <pybind11/stl.h>

#include <algorithm>
#include <filesystem>
#include <utility>

#include "src/python/bindings.hpp"
#include "src/python/environment.hpp"
#include "src/python/errors.hpp"
#include "src/python/simulation.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/sim/scene/report.hpp"
#include "src/text/quote.hpp"

namespace fiber::python {

std::uint32_t find_fiber(const SimScene& scene, const std::string& name, std::int64_t index) {
  const auto& names = scene.fiber_names;
  const auto count = static_cast<std::int64_t>(names.size());
  if (!name.empty()) {
    index = std::find(names.begin(), names.end(), name) - names.begin();
  }
  if (index < 0 || index >= count) {
    throw std::invalid_argument("there is no fibre " +
                                (name.empty() ? std::to_string(index) : quote(name)) +
                                ", the scene has " + std::to_string(count));
  }
  return static_cast<std::uint32_t>(index);
}

std::pair<std::string, std::int64_t> fiber_argument(const py::object& fiber) {
  if (py::isinstance<py::str>(fiber)) {
    return {fiber.cast<std::string>(), -1};
  }
  try {
    return {"", fiber.cast<std::int64_t>()};
  } catch (const py::cast_error&) {
    throw py::type_error("fiber is " + std::string(py::repr(fiber)) +
                         ", it must be a name or an index");
  }
}

namespace {

/// Brings to json what it cannot write of a scene: numpy's arrays and numbers.
py::object to_plain(const py::object& value) {
  refuse_masked(value, "a value of the scene");
  if (py::hasattr(value, "tolist")) {
    return value.attr("tolist")();
  }
  throw py::type_error("a scene holds a " + std::string(py::str(value.get_type())) +
                       ", it must be made of dict, list, str, numbers and arrays");
}

SimDescription read_scene(const py::object& scene, const py::object& folder) {
  if (py::isinstance<py::dict>(scene)) {
    // JSON is YAML.
    const auto text = py::module::import("json")
                          .attr("dumps")(scene, py::arg("default") = py::cpp_function(&to_plain))
                          .cast<std::string>();
    const std::string meshes = folder.is_none() ? "." : to_path(folder);
    const WithoutPythonLock others_may_run;
    return read_sim_scene(parse_yaml(text, "scene"), mesh_files(meshes));
  }
  const std::string path = to_path(scene);
  require_readable(path);
  const std::filesystem::path meshes = folder.is_none() ? std::filesystem::path(path).parent_path()
                                                        : std::filesystem::path(to_path(folder));
  const WithoutPythonLock others_may_run;
  return read_sim_scene(load_yaml(path), mesh_files(meshes));
}

std::shared_ptr<Simulation> make(const py::object& scene, const py::object& folder,
                                 std::int64_t threads) {
  const std::uint32_t most = to_index(threads, "threads");
  SimDescription description = read_scene(scene, folder);
  const WithoutPythonLock others_may_run;
  return std::make_shared<Simulation>(std::move(description), most);
}

void attach_to(Simulation& simulation, const py::object& fiber, std::int64_t node,
               const py::object& position, double speed, const py::object& tangent,
               const py::object& director, double max_force) {
  HoldRequest request;
  request.target = to_vector(position, "position");
  request.speed = speed;
  request.max_force = max_force;
  if (!tangent.is_none()) {
    request.tangent = to_vector(tangent, "tangent");
  }
  if (!director.is_none()) {
    request.director = to_vector(director, "director");
  }
  const auto named = fiber_argument(fiber);
  simulation.with([&](SimScene& scene) {
    attach(scene, find_fiber(scene, named.first, named.second), node, request);
  });
}

void detach_from(Simulation& simulation, const py::object& fiber, std::int64_t node) {
  const auto named = fiber_argument(fiber);
  simulation.with([&](SimScene& scene) {
    release_node(scene, find_fiber(scene, named.first, named.second), node);
  });
}

py::dict parameters_of(const Simulation& simulation) {
  const auto all = simulation.with([](SimScene& scene) { return scene.parameters.all(); });
  py::dict dict;
  for (const SimParameter& parameter : all) {
    dict[py::str(parameter.name)] = parameter.value.size() == 1
                                        ? py::object(py::float_(parameter.value.front()))
                                        : py::object(to_array(parameter.value));
  }
  return dict;
}

void set_parameters(Simulation& simulation, const py::dict& values) {
  std::vector<SimParameter> parameters;
  for (const auto& [name, value] : values) {
    const auto text = name.cast<std::string>();
    parameters.push_back(
        {text, to_numbers(py::reinterpret_borrow<py::object>(value), text.c_str())});
  }
  simulation.with([&](SimScene& scene) { scene.parameters.set(parameters); });
}

std::shared_ptr<Fibers> fibers_of(const Simulation& simulation) {
  return std::make_shared<Fibers>(simulation.with([](SimScene& scene) {
    const Rods& rods = scene.stepper->rods();
    return assembly_of(rods);
  }));
}

std::shared_ptr<SharedWorld> environment_of(const Simulation& simulation) {
  const auto objects = simulation.with([](SimScene& scene) { return scene.objects(); });
  auto world = std::make_shared<SharedWorld>();
  std::vector<ObjectChange> changes;
  for (const EnvironmentObject& object : objects) {
    changes.push_back({ObjectChange::Operation::ADD, object});
  }
  world->apply(changes);
  return world;
}

py::dict report_of(const Simulation& simulation) {
  const StepReport report =
      simulation.with([](SimScene& scene) { return scene.stepper->report(); });
  py::dict dict;
  dict["iterations"] = report.iterations;
  dict["unbalanced"] = report.unbalanced;
  dict["residual"] = report.worst.residual;
  dict["residual_force"] = report.worst.residual_force;
  dict["residual_fiber"] = report.worst.rod;
  dict["residual_node"] = report.worst.node;
  dict["energy_gain"] = report.energy_gain;
  return dict;
}

std::vector<std::string> warnings_of(const Simulation& simulation) {
  return simulation.with([](SimScene& scene) {
    std::vector<std::string> texts;
    for (const SimWarning& warning : frame_warnings(scene)) {
      texts.push_back(warning.text);
    }
    return texts;
  });
}

constexpr const char* simulation_doc = R"(
Fibres that move: discrete elastic rods with the effects that a scene names.

One thread at a time works with a simulation, others wait.

Parameters
----------
scene : str or os.PathLike of a YAML file, or a dict of the same fields
    docs/scene_keys.md says what they mean. Arrays of numpy may stand for lists.
folder : str or os.PathLike, optional
    Where paths of meshes begin; that of the file by default.
threads : int, default 0
    Most threads to use, 0 for as many as there are cores. What comes does not depend on it.

Raises
------
ValueError
    Naming line, field and value for what a scene may not hold.
FileNotFoundError
    For a file that is not there.
RuntimeError
    Of a step that diverges; then ``reset()`` begins again.

>>> from fiber_proximity import Simulation
>>> simulation = Simulation({
...     "fibers": [{"name": "cable", "material": "power_cable", "radius": 0.005,
...                 "segments": 20, "shape": {"line": {"from": [0, 0, 1], "to": [0.5, 0, 1]}}}],
...     "effects": ["gravity", "stretch", "bend", "attachment"]})
>>> simulation.attach("cable", 0, [0, 0, 1])
>>> simulation.step(30)
>>> round(simulation.time, 6), simulation.positions.shape
(0.5, (21, 3))
>>> bool(simulation.positions[-1, 2] < 0.9)
True
)";

constexpr const char* attach_doc = R"(
Holds a node of a fibre, in place of what holds it; the scene must name the effect attachment.

Parameters
----------
fiber : str or int
    Its name or index.
node : int
    Negative ones count from the end.
position : (3,) [m]
    Where the node is to be. To follow a gripper, call this before each step.
speed : float [m/s], default 0
    With which it goes there; 0: within the next step.
tangent : (3,) of unit length, optional
    Of the fibre there: makes it a clamp, which only ends of fibres can have. Without: a pin.
director : (3,) of unit length, across the tangent, optional
    Of clamps of fibres that twist.
max_force : float [N], default 0
    With which it pulls at most; 0: what stretches the fibre by a tenth.

Raises
------
ValueError
    For a position that another hold of the fibre does not let it reach; nothing changes then.
)";

template <class Read>
py::cpp_function points_by(const Read& read) {
  return py::cpp_function([read](const Simulation& simulation) {
    return to_array(simulation.with([&](SimScene& scene) { return read(scene.stepper->rods()); }));
  });
}

}  // namespace

void bind_simulation(py::module& module) {
  bind_forces(module);
  py::class_<Simulation, std::shared_ptr<Simulation>>(module, "Simulation", simulation_doc)
      .def(py::init(&make), py::arg("scene"), py::arg("folder") = py::none(),
           py::arg("threads") = 0)
      .def(
          "step",
          [](Simulation& simulation, std::int64_t frames) {
            simulation.step(to_index(frames, "frames"));
          },
          py::arg("frames") = 1, "Moves on by as many frames of ``time_step``.")
      .def("reset", &Simulation::reset, "Begins again, as the scene is written.")
      .def("attach", &attach_to, py::arg("fiber"), py::arg("node"), py::arg("position"),
           py::arg("speed") = 0.0, py::arg("tangent") = py::none(),
           py::arg("director") = py::none(), py::arg("max_force") = 0.0, attach_doc)
      .def("detach", &detach_from, py::arg("fiber"), py::arg("node"),
           "Lets go of a node. ValueError if nothing holds it.")
      .def("predict", &predict, py::arg("duration"), py::arg("trajectories") = py::list(),
           py::arg("sample_period") = 0.0, py::arg("margin") = 0.1, predict_doc)
      .def("set_parameters", &set_parameters, py::arg("values"),
           "Changes parameters of effects, all or none: a dict of names, such as "
           "'gravity.acceleration', and numbers or vectors.")
      .def_property_readonly("parameters", &parameters_of,
                             "Parameters of the effects that may change: a dict.")
      .def_property_readonly("positions",
                             points_by([](const Rods& rods) { return rods.positions; }),
                             "(n, 3) float64 [m]: where the points are, a copy; of a closed fibre "
                             "the first one again behind its last.")
      .def_property_readonly("velocities",
                             points_by([](const Rods& rods) { return rods.velocities; }),
                             "(n, 3) float64 [m/s]: how they move, a copy.")
      .def_property_readonly("fibers", &fibers_of, "New Fibers: where they are now, for queries.")
      .def_property_readonly("environment", &environment_of,
                             "A new Environment: the objects of the scene.")
      .def_property_readonly("forces", &forces_of, "Forces of the last step, as it has found them.")
      .def_property_readonly(
          "names",
          [](const Simulation& simulation) {
            return simulation.with([](SimScene& scene) { return scene.fiber_names; });
          },
          "Names of the fibres, a list of str.")
      .def_property_readonly(
          "time",
          [](const Simulation& simulation) {
            return simulation.with([](SimScene& scene) { return scene.stepper->time(); });
          },
          "[s] since the beginning.")
      .def_property_readonly(
          "time_step",
          [](const Simulation& simulation) {
            return simulation.with([](SimScene& scene) { return scene.time_step; });
          },
          "[s] of a frame.")
      .def_property_readonly(
          "energy",
          [](const Simulation& simulation) {
            return simulation.with([](SimScene& scene) { return scene.stepper->energy(); });
          },
          "[J] Kinetic and stored energy; before the first step the kinetic one alone.")
      .def_property_readonly("report", &report_of,
                             "How well the last step is balanced, a dict: iterations, unbalanced, "
                             "residual [m/s], residual_force [N], residual_fiber, residual_node, "
                             "energy_gain [J].")
      .def_property_readonly("warnings", &warnings_of,
                             "What is not as the scene wants it after the last frame, a list of "
                             "str: stretched edges, holds that lag, forces out of balance.")
      .def_property_readonly(
          "note",
          [](const Simulation& simulation) {
            return simulation.with([](SimScene& scene) { return scene.overlap_note; });
          },
          "What was moved apart before the beginning; empty if nothing was.");
}

}  // namespace fiber::python
