#include "fiber_proximity/cuda/device_proximity.hpp"

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/cuda/device.hpp"
#include "src/python/arrays.hpp"
#include "src/python/bindings.hpp"
#include "src/python/device_arrays.hpp"
#include "src/text/quote.hpp"

namespace fiber::python {
namespace {

std::unique_ptr<Device> device_of(const std::string& name) {
  if (name == "gpu") {
    return make_cuda_device();
  }
  if (name == "host") {
    return make_host_device();
  }
  throw std::invalid_argument("unknown device " + quote(name) + ", known are: gpu, host");
}

/// One of the fibres' engine on the GPU, as Python has it.
class PythonDeviceProximity {
 public:
  PythonDeviceProximity(const py::object& offsets, const py::object& radii,
                        const std::string& device, const py::object& candidates)
      : proximity_(candidates.is_none()
                       ? std::make_unique<DeviceProximity>(device_of(device),
                                                           to_indices(offsets, "offsets"),
                                                           to_numbers(radii, "radii"))
                       : std::make_unique<DeviceProximity>(
                             device_of(device), to_indices(offsets, "offsets"),
                             to_numbers(radii, "radii"), to_indices(candidates, "candidates"))) {}

  void update(const py::object& points) {
    if (const auto on_device =
            DevicePoints::of(points, proximity_->gpu().has_value(), proximity_->point_count())) {
      const WithoutPythonLock others_may_run;
      const std::lock_guard<std::mutex> lock(mutex_);
      if (on_device->is_single) {
        proximity_->update(reinterpret_cast<const float*>(on_device->address));
      } else {
        proximity_->update(reinterpret_cast<const double*>(on_device->address));
      }
      return;
    }
    const std::vector<Eigen::Vector3d> on_host = to_points(points, "points");
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    proximity_->update_from_host(on_host);
  }

  DeviceProximity::Contacts query(const DeviceProximity::Options& options) {
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    return proximity_->query(options);
  }

  py::array_t<bool> check(const DeviceProximity::Options& options) {
    std::vector<std::uint8_t> touching;
    {
      const WithoutPythonLock others_may_run;
      const std::lock_guard<std::mutex> lock(mutex_);
      proximity_->check_candidates(options, touching);
    }
    py::array_t<bool> answer(static_cast<Py_ssize_t>(touching.size()));
    std::copy(touching.begin(), touching.end(), answer.mutable_data());
    return answer;
  }

  void copy_to_host(const DeviceProximity::Contacts& contacts,
                    DeviceProximity::HostContacts& copy) {
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    proximity_->copy_to_host(contacts, copy);
  }

  std::optional<int> gpu() const { return proximity_->gpu(); }
  std::size_t candidate_count() const { return proximity_->candidate_count(); }
  double device_seconds() const { return proximity_->device_seconds(); }

 private:
  std::unique_ptr<DeviceProximity> proximity_;
  std::mutex mutex_;
};

/// @param neighbour_skip None for the rule of loops
DeviceProximity::Options to_device_options(double margin, const py::object& neighbour_skip,
                                           const std::string& pairing, bool with_itself) {
  DeviceProximity::Options options{margin, std::nullopt, pairing_from_name(pairing), with_itself};
  if (!neighbour_skip.is_none()) {
    options.neighbour_skip = to_index(neighbour_skip.cast<std::int64_t>(), "neighbour_skip");
  }
  return options;
}

/// The contacts of one query: there as long as somebody holds it, or an array that was taken of it.
class PythonDeviceContacts {
 public:
  PythonDeviceContacts(std::shared_ptr<PythonDeviceProximity> of,
                       const DeviceProximity::Options& options)
      : of_(std::move(of)), contacts_(of_->query(options)) {}

  std::uint32_t count() const { return contacts_.count; }

  template <class Value>
  DeviceValues values(const Value* data) const {
    return {data, contacts_.count, sizeof(Value), of_->gpu()};
  }

  bool has_candidates() const { return contacts_.candidate_begins != nullptr; }
  DeviceValues candidate_begins() const {
    return {contacts_.candidate_begins, of_->candidate_count() + 1, sizeof(std::uint32_t),
            of_->gpu()};
  }

  py::dict to_host() const {
    DeviceProximity::HostContacts copy;
    of_->copy_to_host(contacts_, copy);
    py::dict arrays;
    arrays["a"] = to_array(py::dtype("u4"), copy.a);
    arrays["b"] = to_array(py::dtype("u4"), copy.b);
    arrays["s"] = to_array(py::dtype("f8"), copy.s);
    arrays["t"] = to_array(py::dtype("f8"), copy.t);
    arrays["distance"] = to_array(py::dtype("f8"), copy.distance);
    if (!copy.candidate_begins.empty()) {
      arrays["candidate_begins"] = to_array(py::dtype("u4"), copy.candidate_begins);
    }
    return arrays;
  }

  const DeviceProximity::Contacts& contacts() const { return contacts_; }

 private:
  std::shared_ptr<PythonDeviceProximity> of_;
  DeviceProximity::Contacts contacts_;
};

/// One array of contacts.
struct PythonDeviceArray {
  std::shared_ptr<PythonDeviceContacts> contacts;
  DeviceValues (*values_of)(const PythonDeviceContacts&);

  DeviceValues values() const { return values_of(*contacts); }
};

template <auto member>
PythonDeviceArray array_of(const std::shared_ptr<PythonDeviceContacts>& contacts) {
  return {contacts,
          [](const PythonDeviceContacts& of) { return of.values(of.contacts().*member); }};
}

std::optional<PythonDeviceArray> candidate_begins_of(
    const std::shared_ptr<PythonDeviceContacts>& contacts) {
  if (!contacts->has_candidates()) {
    return std::nullopt;
  }
  return PythonDeviceArray{contacts,
                           [](const PythonDeviceContacts& of) { return of.candidate_begins(); }};
}

/// @throws py::buffer_error for what only a copy could be
py::capsule dlpack_of(const PythonDeviceArray& array, const py::object& /*stream*/,
                      const py::object& /*max_version*/, const py::object& dl_device,
                      const py::object& copy) {
  const DeviceValues values = array.values();
  if (!dl_device.is_none() && !to_dlpack_device(values).equal(dl_device)) {
    throw py::buffer_error("the array is on the device " +
                           py::str(to_dlpack_device(values)).cast<std::string>() +
                           " and goes to no other");
  }
  if (!copy.is_none() && copy.cast<bool>()) {
    throw py::buffer_error("the array is shared, never copied");
  }
  return to_dlpack(values, array.contacts);
}

}  // namespace

void bind_device_proximity(py::module& module) {
  py::class_<PythonDeviceArray>(
      module, "DeviceArray",
      "Values on a GPU, to be read by whoever takes such, by DLPack or CUDA's array interface: "
      "cupy, torch, jax, warp, numba. They are not to be written.")
      .def_property_readonly(
          "__cuda_array_interface__",
          [](const PythonDeviceArray& array) { return to_cuda_array_interface(array.values()); })
      // They are written when query() returns: no stream has to wait.
      .def("__dlpack__", &dlpack_of, py::kw_only(), py::arg("stream") = py::none(),
           py::arg("max_version") = py::none(), py::arg("dl_device") = py::none(),
           py::arg("copy") = py::none())
      .def("__dlpack_device__",
           [](const PythonDeviceArray& array) { return to_dlpack_device(array.values()); })
      .def("__len__", [](const PythonDeviceArray& array) { return array.values().count; });

  using Contacts = std::shared_ptr<PythonDeviceContacts>;
  py::class_<PythonDeviceContacts, Contacts>(
      module, "DeviceContacts",
      "Contacts on a GPU, sorted by a, then b; there as long as this or one of its arrays is held: "
      "the next query() takes other memory.")
      .def_property_readonly(
          "a", [](const Contacts& all) { return array_of<&DeviceProximity::Contacts::a>(all); },
          "First points of the segments, uint32, the smaller one of each pair.")
      .def_property_readonly(
          "b", [](const Contacts& all) { return array_of<&DeviceProximity::Contacts::b>(all); },
          "The other ones.")
      .def_property_readonly(
          "s", [](const Contacts& all) { return array_of<&DeviceProximity::Contacts::s>(all); },
          "Where on segment a, from 0 to 1, float64.")
      .def_property_readonly(
          "t", [](const Contacts& all) { return array_of<&DeviceProximity::Contacts::t>(all); },
          "Where on segment b.")
      .def_property_readonly(
          "distance",
          [](const Contacts& all) { return array_of<&DeviceProximity::Contacts::distance>(all); },
          "Signed gap of the surfaces [m], float64.")
      .def_property_readonly(
          "candidate_begins", &candidate_begins_of,
          "Which contact is the first of each candidate, and how many there are: uint32, one more "
          "than candidates. None without candidates.")
      .def("to_host", &PythonDeviceContacts::to_host,
           "All five as arrays of numpy, in a dict by their names. With candidates also "
           "`candidate_begins`: which contact is the first of each, and how many there are.")
      .def("__len__", &PythonDeviceContacts::count);

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
                             "What the last update and the last query took on the GPU [s].");
}

}  // namespace fiber::python
