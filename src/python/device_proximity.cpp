#include "src/python/device_proximity.hpp"

#include <cstdint>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/python/arrays.hpp"
#include "src/python/bindings.hpp"
#include "src/python/device_contacts.hpp"
#include "src/text/quote.hpp"

namespace fiber::python {

std::unique_ptr<Device> make_device(const std::string& name) {
  if (name == "gpu") {
    return make_cuda_device();
  }
  if (name == "host") {
    return make_host_device();
  }
  throw std::invalid_argument("unknown device " + quote(name) + ", known are: gpu, host");
}

namespace {

/// @param neighbour_skip None for the rule of loops
DeviceProximity::Options to_device_options(double margin, const py::object& neighbour_skip,
                                           const std::string& pairing, bool with_itself) {
  DeviceProximity::Options options{margin, std::nullopt, pairing_from_name(pairing), with_itself};
  if (!neighbour_skip.is_none()) {
    options.neighbour_skip = to_index(neighbour_skip.cast<std::int64_t>(), "neighbour_skip");
  }
  return options;
}

/// An array of points that stays where it is for as long as this is held, and not released.
class PythonLockedPoints {
 public:
  PythonLockedPoints(std::shared_ptr<PythonDeviceProximity> of, const py::object& points)
      : of_(std::move(of)), points_(points) {
    if (!py::isinstance<Doubles>(points)) {
      throw py::type_error(
          "points that are locked must be an array of numpy, of float64 in C order: of others a "
          "copy is taken in each update");
    }
    lock_ = of_->lock(to_point_array(points, "points"));
  }
  ~PythonLockedPoints() { of_->release(lock_); }
  PythonLockedPoints(const PythonLockedPoints&) = delete;
  PythonLockedPoints& operator=(const PythonLockedPoints&) = delete;

  void release() {
    of_->release(lock_);
    points_ = py::none();
  }

 private:
  std::shared_ptr<PythonDeviceProximity> of_;
  py::object points_;
  std::shared_ptr<void> lock_;
};

}  // namespace

void bind_device_proximity(py::module& module) {
  py::class_<PythonLockedPoints>(module, "LockedPoints",
                                 "Points that a GPU reads where they lie, until they are released.")
      .def("release", &PythonLockedPoints::release)
      .def("__enter__", [](py::object self) { return self; })
      .def("__exit__", [](PythonLockedPoints& self, const py::args& /*error*/) { self.release(); });

  py::class_<PythonDeviceProximity, std::shared_ptr<PythonDeviceProximity>>(module,
                                                                            "DeviceProximity", R"(
Contacts of fibres whose points are on a GPU, left there.

Pairs, parameters and distances are those of every engine, bit for bit. The rule of loops is not
asked: neighbours are left out by their number.

Parameters
----------
offsets : array (fibres + 1,) of int
    From 0 to the number of points.
radii : float or array (fibres,) or (n,)
    [m]
device : str
    ``gpu``, or ``host``: the same code as loops on the processor, to try things where no GPU is.
candidates : array (candidates + 1,) of int, optional
    Fibres ``candidates[c]`` to ``candidates[c + 1] - 1`` are candidate c, as ``check()`` has them;
    those from the last value on stand still. A candidate meets itself and what stands still, and
    no other candidate.
)")
      .def(py::init<const py::object&, const py::object&, std::string, const py::object&>(),
           py::arg("offsets"), py::arg("radii"), py::arg("device") = "gpu",
           py::arg("candidates") = py::none())
      .def("update", &PythonDeviceProximity::update, py::arg("points"), R"(
Takes the points, (n, 3) [m]: an array on the GPU of float32 or float64 in C order, that offers
``__cuda_array_interface__`` or ``__dlpack__`` (cupy, torch, jax, warp, numba), or one on the host.

Raises ValueError for another shape or order, and for coordinates that are not finite, TypeError
for other numbers.
)")
      .def(
          "query",
          [](const std::shared_ptr<PythonDeviceProximity>& self, double margin,
             std::int64_t neighbour_skip, const std::string& pairing, bool with_itself) {
            return std::make_shared<PythonDeviceContacts>(
                self, to_device_options(margin, py::int_(neighbour_skip), pairing, with_itself));
          },
          py::arg("margin") = 0.0, py::arg("neighbour_skip") = 1, py::arg("pairing") = "all",
          py::arg("with_itself") = true, R"(
Finds all contacts within a finite margin [m]; a DeviceContacts.

``neighbour_skip`` leaves out segments of one fibre whose indices differ by at most this;
``pairing`` is ``all``, ``same_fiber`` or ``different_fibers``. Without ``with_itself`` candidates
have contacts with what stands still alone.
)")
      .def(
          "query_to_host",
          [](PythonDeviceProximity& self, double margin, std::int64_t neighbour_skip,
             const std::string& pairing, bool with_itself) {
            return to_host_arrays(self.query_to_host(to_device_options(
                                      margin, py::int_(neighbour_skip), pairing, with_itself)),
                                  self.candidate_count());
          },
          py::arg("margin") = 0.0, py::arg("neighbour_skip") = 1, py::arg("pairing") = "all",
          py::arg("with_itself") = true, R"(
The contacts of ``query()`` as ``to_host()`` has them: each part goes over while the next is found,
into arrays that cannot be written. They stay as they are as long as they are held.
)")
      .def(
          "lock_points",
          [](const std::shared_ptr<PythonDeviceProximity>& self, const py::object& points) {
            return std::make_unique<PythonLockedPoints>(self, points);
          },
          py::arg("points"), R"(
Page-locks an array of points (n, 3), float64 in C order, so that the GPU reads it by itself in
each ``update()``: for arrays that are written anew and stay where they are. As long as the result
is held, until its ``release()``, or in a ``with``. Takes as long as many frames.

Raises TypeError for other arrays, ValueError if it is locked already.
)")
      .def(
          "check_candidates",
          [](PythonDeviceProximity& self, double margin, const py::object& neighbour_skip,
             const std::string& pairing, bool with_itself) {
            return self.check(to_device_options(margin, neighbour_skip, pairing, with_itself));
          },
          py::arg("margin") = 0.0, py::arg("neighbour_skip") = py::none(),
          py::arg("pairing") = "all", py::arg("with_itself") = true, R"(
Which candidates touch themselves or what stands still: an array (candidates,) of bool on the host.

Without ``neighbour_skip`` the rule of loops tells contacts of a fibre with itself from neighbours,
as in ``check()``; else as in ``query()``. The first contact of a candidate ends what is looked for.
)")
      .def_property_readonly("device_seconds", &PythonDeviceProximity::device_seconds,
                             "What the last update and the last query took on the GPU [s].")
      .def_property_readonly("device_stages", &PythonDeviceProximity::device_stages,
                             "What of that each stage took [s], by its name, in their order.");
}

}  // namespace fiber::python
