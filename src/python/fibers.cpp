#include "src/python/fibers.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <atomic>
#include <limits>

#include "src/python/bindings.hpp"
#include "src/python/curves.hpp"
#include "src/python/fiber_arguments.hpp"

namespace fiber::python {

Fibers::State Fibers::state() const {
  const std::lock_guard<std::mutex> lock(newest_);
  return state_;
}

FiberNames Fibers::names() const {
  const std::lock_guard<std::mutex> lock(newest_);
  return names_;
}

void Fibers::rename(FiberNames names) {
  const std::lock_guard<std::mutex> lock(newest_);
  names_ = std::move(names);
}

void Fibers::move(const double* rows, std::size_t count) {
  const std::lock_guard<std::mutex> one_at_a_time(moving_);
  copy_points(rows, count, incoming_);
  if (spare_ == nullptr || spare_.use_count() > 1) {
    spare_ = std::make_shared<FiberAssembly>(*state());
  }
  // Who let go of it last has read it before.
  std::atomic_thread_fence(std::memory_order_acquire);
  spare_->exchange_points(incoming_);
  const std::lock_guard<std::mutex> lock(newest_);
  state_.swap(spare_);
}

Fibers::State to_state(const py::object& object, const char* name) {
  if (py::isinstance<Fibers>(object)) {
    return object.cast<const Fibers&>().state();
  }
  throw py::type_error(std::string(name) + " is a " + std::string(py::str(object.get_type())) +
                       ", it must be Fibers");
}

void require_segment(const FiberAssembly& fibers, std::uint32_t fiber, std::uint32_t segment) {
  if (fiber >= fibers.fiber_count() ||
      segment + std::uint64_t{1} >= fibers.offsets()[fiber + 1] - fibers.offsets()[fiber]) {
    throw std::invalid_argument("there is no segment " + std::to_string(segment) + " of fibre " +
                                std::to_string(fiber));
  }
}

namespace {

// Names are bytes that need not be UTF-8: what is none comes and goes as Python has it in paths.

py::list fiber_name_list(const Fibers& fibers) {
  py::list names;
  for (const std::string& name : fibers.names().list(fibers.state()->fiber_count())) {
    names.append(py::reinterpret_steal<py::str>(PyUnicode_DecodeUTF8(
        name.data(), static_cast<Py_ssize_t>(name.size()), "surrogateescape")));
  }
  return names;
}

void rename_fibers(Fibers& fibers, const py::iterable& names) {
  std::vector<std::string> texts;
  for (const py::handle name : names) {
    if (!py::isinstance<py::str>(name)) {
      throw py::type_error("a name is a " + std::string(py::str(name.get_type())) +
                           ", it must be a str");
    }
    PyObject* const bytes = PyUnicode_AsEncodedString(name.ptr(), "utf-8", "surrogateescape");
    if (bytes == nullptr) {
      throw py::error_already_set();
    }
    texts.emplace_back(py::reinterpret_steal<py::bytes>(bytes));
  }
  if (texts.size() != fibers.state()->fiber_count()) {
    throw std::invalid_argument(std::to_string(texts.size()) + " names for " +
                                std::to_string(fibers.state()->fiber_count()) + " fibres");
  }
  fibers.rename(FiberNames(std::move(texts)));
}

py::array points_of(const Fibers& fibers) {
  const Fibers::State state = fibers.state();
  const auto count = static_cast<Py_ssize_t>(state->given_offsets().back());
  if (state->graph() != nullptr) {
    return to_array(state->given_points());
  }
  const double* first = count == 0 ? nullptr : state->points().front().data();
  return view(first, {count, 3}, keep(state));
}

py::array points_of_fiber(const Fibers& fibers, Py_ssize_t index) {
  const Fibers::State state = fibers.state();
  const auto count = static_cast<Py_ssize_t>(state->fiber_count());
  if (index < -count || index >= count) {
    throw py::index_error("there is no fibre " + std::to_string(index) + ", there are " +
                          std::to_string(count));
  }
  const auto fiber = static_cast<std::size_t>(index < 0 ? index + count : index);
  // The repeated point of a closed fibre comes behind those that were given.
  const std::vector<std::uint32_t>& given = state->given_offsets();
  return view(state->points()[state->offsets()[fiber]].data(),
              {static_cast<Py_ssize_t>(given[fiber + 1] - given[fiber]), 3}, keep(state));
}

py::array radii_of(const Fibers& fibers) {
  const Fibers::State state = fibers.state();
  if (state->graph() != nullptr) {
    return to_array(state->given_radii());
  }
  return view(state->radii().data(), {static_cast<Py_ssize_t>(state->radii().size())}, keep(state));
}

/// (fibres,) of bool.
py::array closed_of(const FiberAssembly& fibers) {
  py::array_t<bool> closed(static_cast<Py_ssize_t>(fibers.fiber_count()));
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    closed.mutable_at(static_cast<Py_ssize_t>(fiber)) = fibers.is_closed(fiber);
  }
  return std::move(closed);
}

/// (n,) of int32, -1 of points that are not joined.
py::array joints_of(const FiberAssembly& fibers) {
  std::vector<std::int32_t> joints = fibers.topology().joints;
  joints.resize(fibers.given_offsets().back(), -1);
  return py::array_t<std::int32_t>(static_cast<Py_ssize_t>(joints.size()), joints.data());
}

/// @throws std::invalid_argument for curves that are not of as many points each as the fibres
void move_curves(Fibers& fibers, const py::object& list) {
  const Curves curves = to_curves(list, "points");
  const Fibers::State state = fibers.state();
  const std::vector<std::uint32_t>& offsets = state->given_offsets();
  if (curves.offsets.size() != offsets.size()) {
    throw std::invalid_argument("points is a list of " + std::to_string(curves.offsets.size() - 1) +
                                " curves, there are " + std::to_string(offsets.size() - 1) +
                                " fibres");
  }
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    const std::uint32_t given = curves.offsets[i + 1] - curves.offsets[i];
    if (given != offsets[i + 1] - offsets[i]) {
      throw std::invalid_argument("points[" + std::to_string(i) + "] has " + std::to_string(given) +
                                  " points, fibre " + std::to_string(i) + " has " +
                                  std::to_string(offsets[i + 1] - offsets[i]));
    }
  }
  const WithoutPythonLock others_may_run;
  fibers.move(curves.points.front().data(), curves.points.size());
}

void move(Fibers& fibers, const py::object& points) {
  if (is_list_of_curves(points)) {
    move_curves(fibers, points);
    return;
  }
  const Doubles array = to_doubles(points, "points");
  if ((array.ndim() != 2 && array.ndim() != 3) || array.shape(array.ndim() - 1) != 3) {
    refuse_shape(array, "points", "(n, 3) or (fibres, n, 3)");
  }
  const double* rows = array.data();
  const auto count = static_cast<std::size_t>(array.size() / 3);
  const WithoutPythonLock others_may_run;
  fibers.move(rows, count);
}

/// Arguments from which copy and pickle make another one: of its class, which may be a subclass,
/// with what it holds besides. Python's own way would leave the C++ part out.
py::tuple reduce(const py::object& self) {
  const auto& fibers = self.cast<const Fibers&>();
  const Fibers::State state = fibers.state();
  const py::tuple arguments =
      py::make_tuple(self.get_type(), to_array(state->given_points()), state->given_offsets(),
                     to_array(state->given_radii()), fiber_name_list(fibers), closed_of(*state),
                     joints_of(*state), state->topology().joint_tolerance);
  // Python has __getstate__ of all objects since 3.11.
  const py::object besides = py::hasattr(self, "__getstate__")
                                 ? py::object(self.attr("__getstate__")())
                                 : py::getattr(self, "__dict__", py::none());
  return py::make_tuple(py::module::import("fiber_proximity").attr("_restore_fibers"), arguments,
                        besides);
}

std::string describe(const Fibers& fibers) {
  const Fibers::State state = fibers.state();
  return "<fiber_proximity.Fibers: " + std::to_string(state->fiber_count()) + " fibres of " +
         std::to_string(state->given_offsets().back()) + " points>";
}

}  // namespace

void bind_fibers(py::module& module) {
  py::class_<Fibers, std::shared_ptr<Fibers>>(module, "Fibers", R"(
Fibres, each a chain of points with a radius.

Consecutive points of a fibre make a segment, a capped cylinder; where the radii of its two points
differ, one of the larger radius. The points are copied and checked once.

Parameters
----------
points : (n, 3) of real numbers [m], (fibres, n, 3) for fibres of as many points each, or a list of
    curves, (n, 3) each
offsets : (fibres + 1,) of whole numbers, optional
    Fibre f owns points[offsets[f]:offsets[f + 1]], at least two. Without: one fibre, or what the
    shape of points says.
radii : number, (fibres,) or (n,) [m], default 0
    For a list of curves also a list: a number or (n,) for each.
closed : bool or (fibres,) of bool, default none
    Whether a segment leads from the last point of a fibre to its first, which is not repeated.
joints : (n,) of whole numbers, default none
    Points of the same number, of one fibre or several, are joined: neighbours, which have no
    contact. Below 0: not joined. Warns (UserWarning) of a number that one point alone has.
joint_tolerance : float [m], optional
    How far joined points may be apart; the largest radius that meets there, if not given.

Raises
------
ValueError
    For a shape that is not allowed, offsets that do not fit, coordinates or radii that are not
    finite, closed fibres of less than three points, joined points that do not meet; names fibre,
    point and value.
TypeError
    For arrays of anything but real numbers.

>>> import numpy as np
>>> from fiber_proximity import Fibers
>>> fibers = Fibers([[0, 0, 0], [1, 0, 0], [0, 1, 0], [1, 1, 0]], offsets=[0, 2, 4], radii=0.01)
>>> len(fibers)
2
>>> fibers[1]
array([[0., 1., 0.],
       [1., 1., 0.]])
>>> fibers = Fibers([np.zeros((3, 3)), np.ones((4, 3))], radii=[0.01, [0.01, 0.01, 0.02, 0.02]])
>>> fibers.offsets
array([0, 3, 7], dtype=uint32)
>>> ring = Fibers([[0, 0, 0], [1, 0, 0], [1, 1, 0], [0, 1, 0]], radii=0.01, closed=True)
>>> ring.segment_count
4
)")
      .def(py::init([](const py::object& points, const py::object& offsets, const py::object& radii,
                       const py::object& closed, const py::object& joints,
                       const py::object& joint_tolerance) {
             return std::make_shared<Fibers>(
                 make_fibers(points, offsets, radii, closed, joints, joint_tolerance));
           }),
           py::arg("points"), py::arg("offsets") = py::none(), py::arg("radii") = 0.0,
           py::arg("closed") = py::none(), py::arg("joints") = py::none(),
           py::arg("joint_tolerance") = py::none())
      .def("move", &move, py::arg("points"), R"(
Moves the points, for the next frame; which fibre owns which stays, and so do the radii.

They are copied once. Engines go on with where the fibres were until their next ``update()``.

Parameters
----------
points : (n, 3), (fibres, n, 3) or a list of curves, (n, 3) each, as many as there are [m]

Raises
------
ValueError
    For another number of points, or coordinates that are not finite; nothing has moved then.

>>> fibers = Fibers([[0, 0, 0], [1, 0, 0]])
>>> fibers.move(fibers.points + [0, 0, 1])
>>> fibers.points[:, 2]
array([1., 1.])
)")
      .def_property_readonly("points", &points_of,
                             "(n, 3) float64 [m], read-only: the points as they are now. An array "
                             "taken before ``move()`` keeps showing those before.")
      .def_property_readonly(
          "offsets",
          [](const Fibers& fibers) {
            const Fibers::State state = fibers.state();
            return view(state->given_offsets().data(), state->given_offsets().size(), keep(state));
          },
          "(fibres + 1,) uint32, read-only: index of each fibre's first point, then the number of "
          "points.")
      .def_property_readonly("radii", &radii_of,
                             "(1,), (fibres,) or (n,) float64 [m], read-only: as they were given.")
      .def_property_readonly(
          "closed", [](const Fibers& fibers) { return closed_of(*fibers.state()); },
          "(fibres,) of bool: whether a fibre's last segment leads to its first point.")
      .def_property_readonly(
          "joints", [](const Fibers& fibers) { return joints_of(*fibers.state()); },
          "(n,) int32: points of the same number are joined; -1 of those that are not.")
      .def_property("names", &fiber_name_list, &rename_fibers,
                    "What the fibres are called, (fibres,) of str: as in the file that they were "
                    "read from, and where they are written; without names, their indices.")
      .def_property_readonly(
          "segment_count", [](const Fibers& fibers) { return fibers.state()->segment_count(); },
          "Number of segments of all fibres.")
      .def_property_readonly(
          "point_count",
          [](const Fibers& fibers) { return fibers.state()->given_offsets().back(); },
          "Number of points of all fibres.")
      .def("__len__", [](const Fibers& fibers) { return fibers.state()->fiber_count(); })
      .def("__getitem__", &points_of_fiber, py::arg("fiber"),
           "(n, 3) float64 [m], read-only: the points of one fibre.")
      .def(
          "select",
          [](const Fibers& fibers, const py::object& selection) {
            const Fibers::State state = fibers.state();
            const std::vector<std::uint32_t> indices = to_indices(selection, "fibers");
            for (const std::uint32_t index : indices) {
              if (index >= state->fiber_count()) {
                throw py::index_error("there is no fibre " + std::to_string(index) +
                                      ", there are " + std::to_string(state->fiber_count()));
              }
            }
            return std::make_shared<Fibers>(select_fibers(*state, indices),
                                            fibers.names().select(indices));
          },
          py::arg("fibers"), "New Fibers: some of these, by index, in this order.")
      .def(
          "copy",
          [](const Fibers& fibers) {
            return std::make_shared<Fibers>(*fibers.state(), fibers.names());
          },
          "New Fibers that move on their own; copy.copy() keeps a subclass, too.")
      .def("__reduce__", &reduce)
      .def("__repr__", &describe);
}

}  // namespace fiber::python
