#pragma once

#include <cstddef>
#include <memory>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "src/python/device_proximity.hpp"

namespace fiber::python {

// Numbers of points are below 2^31 (SegmentTreeView::max_segments). They are given as int32: torch
// takes no uint32.

/// Where the contacts of candidates begin is int32, too.
/// @throws std::overflow_error for more contacts than that counts
void require_int32(std::uint32_t contact_count);

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
    require_int32(contacts_.count);
    return {contacts_.candidate_begins, of_->candidate_count() + 1, sizeof(std::uint32_t),
            of_->gpu()};
  }

  py::dict to_host() const {
    DeviceProximity::HostContacts copy;
    of_->copy_to_host(contacts_, copy);
    py::dict arrays;
    arrays["a"] = to_array(py::dtype("i4"), copy.a);
    arrays["b"] = to_array(py::dtype("i4"), copy.b);
    arrays["s"] = to_array(py::dtype("f8"), copy.s);
    arrays["t"] = to_array(py::dtype("f8"), copy.t);
    arrays["distance"] = to_array(py::dtype("f8"), copy.distance);
    if (!copy.candidate_begins.empty()) {
      require_int32(contacts_.count);
      arrays["candidate_begins"] = to_array(py::dtype("i4"), copy.candidate_begins);
    }
    return arrays;
  }

  const DeviceProximity::Contacts& contacts() const { return contacts_; }

 private:
  std::shared_ptr<PythonDeviceProximity> of_;
  DeviceProximity::Contacts contacts_;
};

/// The contacts of one query, as arrays of the host that cannot be written.
py::dict to_host_arrays(const DeviceProximity::Contacts& contacts, std::size_t candidates);

}  // namespace fiber::python
