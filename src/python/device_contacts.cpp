#include "src/python/device_contacts.hpp"

#include <cstdint>
#include <limits>
#include <optional>
#include <stdexcept>
#include <string>
#include <vector>

#include "src/python/bindings.hpp"
#include "src/python/device_arrays.hpp"

namespace fiber::python {
namespace {

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

void require_int32(std::uint32_t contact_count) {
  if (contact_count > static_cast<std::uint32_t>(std::numeric_limits<std::int32_t>::max())) {
    throw std::overflow_error(std::to_string(contact_count) +
                              " contacts of candidates, candidate_begins counts to 2147483647: ask "
                              "fewer candidates at once");
  }
}

py::dict to_host_arrays(const DeviceProximity::Contacts& contacts, std::size_t candidates) {
  const py::capsule owner = keep(contacts.memory);
  const std::size_t count = contacts.count;
  const std::vector<Py_ssize_t> shape{static_cast<Py_ssize_t>(count)};
  py::dict arrays;
  arrays["a"] = view(contacts.a, count, owner).attr("view")("i4");
  arrays["b"] = view(contacts.b, count, owner).attr("view")("i4");
  arrays["s"] = view(contacts.s, shape, owner);
  arrays["t"] = view(contacts.t, shape, owner);
  arrays["distance"] = view(contacts.distance, shape, owner);
  if (contacts.candidate_begins != nullptr) {
    require_int32(contacts.count);
    arrays["candidate_begins"] =
        view(contacts.candidate_begins, candidates + 1, owner).attr("view")("i4");
  }
  return arrays;
}

void bind_device_contacts(py::module& module) {
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
          "First points of the segments, int32, the smaller one of each pair.")
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
          "Which contact is the first of each candidate, and how many there are: int32, one more "
          "than candidates. None without candidates.")
      .def("to_host", &PythonDeviceContacts::to_host,
           "All five as arrays of numpy, in a dict by their names. With candidates also "
           "`candidate_begins`: which contact is the first of each, and how many there are.")
      .def("__len__", &PythonDeviceContacts::count);
}

}  // namespace fiber::python
