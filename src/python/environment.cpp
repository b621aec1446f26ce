#include "src/python/environment.hpp"

#include <pybind11/stl.h>

#include <filesystem>
#include <limits>
#include <tuple>
#include <utility>

#include "fiber_proximity/environment/scene/environment_scene.hpp"
#include "src/python/bindings.hpp"
#include "src/python/contacts.hpp"
#include "src/python/errors.hpp"
#include "src/python/fibers.hpp"
#include "src/python/options.hpp"

namespace fiber::python {
namespace {

/// The objects there are now; made where something has changed.
std::shared_ptr<const Environment> snapshot(const SharedWorld& world) {
  const WithoutPythonLock others_may_run;
  return world.environment();
}

void append(SharedWorld& world, const std::string& name, const SharedWorld& parts,
            const py::object& pose) {
  ObjectChange change;
  change.operation = ObjectChange::Operation::APPEND;
  change.object.name = name;
  const Eigen::Isometry3d placed = to_pose(pose);
  const auto added = snapshot(parts);
  for (const EnvironmentObject& part : added->objects()) {
    for (const PlacedShape& shape : part.shapes) {
      change.object.shapes.push_back({shape.shape, placed * part.pose * shape.pose});
    }
  }
  const WithoutPythonLock others_may_run;
  world.apply({change});
}

void change_one(SharedWorld& world, ObjectChange::Operation operation, const std::string& name,
                const py::object& pose) {
  ObjectChange change;
  change.operation = operation;
  change.object.name = name;
  change.object.pose = to_pose(pose);
  const WithoutPythonLock others_may_run;
  world.apply({change});
}

std::vector<std::string> names_of(const SharedWorld& world) {
  std::vector<std::string> names;
  const auto environment = snapshot(world);
  for (const EnvironmentObject& object : environment->objects()) {
    names.push_back(object.name);
  }
  return names;
}

py::array pose_of(const SharedWorld& world, const std::string& name) {
  const auto environment = snapshot(world);
  for (const EnvironmentObject& object : environment->objects()) {
    if (object.name == name) {
      py::array_t<double> pose(std::vector<Py_ssize_t>{4, 4});
      for (Py_ssize_t row = 0; row < 4; ++row) {
        for (Py_ssize_t column = 0; column < 4; ++column) {
          pose.mutable_at(row, column) = object.pose.matrix()(row, column);
        }
      }
      return pose;
    }
  }
  throw py::key_error(name);
}

void read_file(SharedWorld& world, const std::string& path) {
  require_readable(path);
  const WithoutPythonLock others_may_run;
  const MeshSource meshes = mesh_files(std::filesystem::path(path).parent_path());
  std::vector<ObjectChange> changes;
  for (const SceneObstacle& obstacle : read_environment_scene(load_yaml(path), meshes).obstacles) {
    changes.emplace_back();
    changes.back().object = obstacle.object;
  }
  world.apply(changes);
}

QueryResult environment_query(const SharedWorld& world, const py::object& fibers,
                              const py::object& allowed, const QueryOptions& options) {
  const Fibers::State state = to_state(fibers, "fibers");
  const AllowedPairs pairs = to_allowed(allowed);
  const WithoutPythonLock others_may_run;
  QueryResult result;
  world.environment()->query(*state, options, pairs, result);
  return result;
}

py::array environment_contacts(const SharedWorld& world, const py::object& fibers, double margin,
                               const py::object& allowed, const py::kwargs& options) {
  QueryResult result =
      environment_query(world, fibers, allowed, query_options("all", margin, options));
  return to_array(contact_dtype(), result.contacts);
}

py::object environment_closest(const SharedWorld& world, const py::object& fibers, double margin,
                               const py::object& allowed, const py::kwargs& options) {
  const QueryResult result =
      environment_query(world, fibers, allowed, query_options("closest", margin, options));
  const Contact* found = result.closest();
  return found == nullptr ? py::none() : to_record(contact_dtype(), *found);
}

void require_pair(const Environment& environment, const FiberAssembly& fibers,
                  const MotionContact& contact) {
  require_segment(fibers, contact.fiber_a, contact.segment_a);
  const auto& objects = environment.objects();
  if (contact.fiber_b >= objects.size() ||
      contact.segment_b >= objects[contact.fiber_b].shapes.size()) {
    throw std::invalid_argument("there is no shape " + std::to_string(contact.segment_b) +
                                " of object " + std::to_string(contact.fiber_b));
  }
}

std::shared_ptr<MotionAnswer> environment_motion(const SharedWorld& world,
                                                 const py::object& fibers_before,
                                                 const py::object& fibers_after, double margin,
                                                 const std::string& type, const py::object& later,
                                                 const py::object& allowed,
                                                 const py::kwargs& keywords) {
  const Fibers::State before = to_state(fibers_before, "before");
  const Fibers::State after = to_state(fibers_after, "after");
  const AllowedPairs pairs = to_allowed(allowed);
  const MotionOptions options = motion_options(type, margin, keywords);
  const auto environment = snapshot(world);
  const auto given = to_environment(later);
  const auto moved = given == nullptr ? environment : given;
  MotionResult result;
  {
    const WithoutPythonLock others_may_run;
    environment->query_motion(*before, *after, *moved, options, pairs, result);
  }
  return std::make_shared<MotionAnswer>(result, [=](const MotionContact& contact) {
    require_pair(*environment, *before, contact);
    return environment->first_contact({*before, *after}, *moved, contact);
  });
}

constexpr const char* environment_doc = R"(
What is around the fibres: named objects of solids, planes and meshes.

Objects are added under a name, in place of one of the same name. Poses are (4, 4) matrices, a
position (3,), a position and a quaternion x y z w (7,), or None for the identity [m].

>>> from fiber_proximity import Environment, Fibers
>>> environment = Environment()
>>> environment.add_box("table", size=[1, 1, 0.1], pose=[0, 0, -0.05])
>>> cable = Fibers([[0, 0, 0.02], [0.4, 0, 0.3]], radii=0.005)
>>> float(environment.closest(cable)["distance"].round(6))
0.015
)";

}  // namespace

AllowedPairs to_allowed(const py::object& object) {
  AllowedPairs pairs;
  if (object.is_none()) {
    return pairs;
  }
  for (const py::handle item : object) {
    AllowedPair pair;
    if (py::isinstance<py::str>(item)) {
      pair.object = item.cast<std::string>();
    } else {
      const auto parts = py::reinterpret_borrow<py::object>(item).cast<py::sequence>();
      if (py::len(parts) < 1 || py::len(parts) > 3) {
        throw std::invalid_argument("an allowed pair has " + std::to_string(py::len(parts)) +
                                    " parts, it must have 1 to 3: object, fibre, segments");
      }
      pair.object = py::object(parts[0]).cast<std::string>();
      if (py::len(parts) > 1 && !py::object(parts[1]).is_none()) {
        pair.fiber = to_index(py::object(parts[1]).cast<std::int64_t>(), "the fibre");
      }
      if (py::len(parts) > 2 && !py::object(parts[2]).is_none()) {
        std::tie(pair.first_segment, pair.last_segment) =
            py::object(parts[2]).cast<std::pair<std::int64_t, std::int64_t>>();
      }
    }
    pairs.push_back(pair);
  }
  return pairs;
}

std::shared_ptr<const Environment> to_environment(const py::object& object) {
  if (object.is_none()) {
    return nullptr;
  }
  if (!py::isinstance<SharedWorld>(object)) {
    throw py::type_error("environment is a " + std::string(py::str(object.get_type())) +
                         ", it must be an Environment");
  }
  return snapshot(object.cast<const SharedWorld&>());
}

void bind_environment(py::module& module) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  using Operation = ObjectChange::Operation;
  py::class_<SharedWorld, std::shared_ptr<SharedWorld>> environment(module, "Environment",
                                                                    environment_doc);
  environment.def(py::init([] { return std::make_shared<SharedWorld>(); }));
  bind_shapes(environment);
  environment
      .def("append", &append, py::arg("name"), py::arg("parts"), py::arg("pose") = py::none(),
           "All shapes of another Environment to the object of this name, which may be new: a body "
           "of several shapes.")
      .def(
          "move",
          [](SharedWorld& world, const std::string& name, const py::object& pose) {
            change_one(world, Operation::MOVE, name, pose);
          },
          py::arg("name"), py::arg("pose"), "Brings an object to a pose.")
      .def(
          "remove",
          [](SharedWorld& world, const std::string& name) {
            change_one(world, Operation::REMOVE, name, py::none());
          },
          py::arg("name"), "Takes an object away.")
      .def(
          "read",
          [](SharedWorld& world, const py::object& path) { read_file(world, to_path(path)); },
          py::arg("path"),
          "Adds the `obstacles` of a YAML file as the node's parameter ~scene has them.")
      .def_property_readonly("names", &names_of,
                             "Names of the objects, a list of str: `fiber_b` of a contact with the "
                             "environment is an index of it.")
      .def("pose", &pose_of, py::arg("name"), "(4, 4) float64: where an object is [m].")
      .def("__len__", [](const SharedWorld& world) { return world.object_count(); })
      .def(
          "__contains__",
          [](const SharedWorld& world, const std::string& name) { return world.has(name); },
          py::arg("name"))
      .def("contacts", &environment_contacts, py::arg("fibers"), py::arg("margin") = 0.0,
           py::arg("allowed") = py::none(), R"(
All pairs of a segment (a) and a shape of an object (b) no further apart than the margin.

Parameters
----------
fibers : Fibers
margin : float [m], default 0
allowed : sequence, optional
    Pairs that are left out: names of objects, or tuples (name, fibre, (first segment, last)).

Returns
-------
(m,) of ``contact_dtype``
    `fiber_b` is the index of the object in ``names``, `segment_b` that of the shape in it.
)")
      .def("closest", &environment_closest, py::arg("fibers"), py::arg("margin") = infinity,
           py::arg("allowed") = py::none(),
           "The closest pair within the margin [m], a record of ``contact_dtype``, or None.")
      .def("motion", &environment_motion, py::arg("before"), py::arg("after"),
           py::arg("margin") = 0.0, py::arg("type") = "all", py::arg("later") = py::none(),
           py::arg("allowed") = py::none(),
           "Pairs of a segment and a shape that come into contact while the fibres move from where "
           "they are before to where they are after, and the objects to where they are in `later`, "
           "an Environment of the same objects; as ``Engine.motion()`` otherwise.")
      .def("__repr__", [](const SharedWorld& world) {
        return "<fiber_proximity.Environment: " + std::to_string(world.object_count()) +
               " objects>";
      });
}

}  // namespace fiber::python
