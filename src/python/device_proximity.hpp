#pragma once

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

#include "fiber_proximity/cuda/device_proximity.hpp"
#include "src/cuda/device.hpp"
#include "src/python/arrays.hpp"
#include "src/python/device_arrays.hpp"

namespace fiber::python {

/// @param name gpu or host
/// @throws std::invalid_argument for other names
std::unique_ptr<Device> make_device(const std::string& name);

/// One of the fibres' engine on the GPU, as Python has it.
class PythonDeviceProximity {
 public:
  PythonDeviceProximity(const py::object& offsets, const py::object& radii,
                        const std::string& device, const py::object& candidates)
      : proximity_(candidates.is_none()
                       ? std::make_unique<DeviceProximity>(make_device(device),
                                                           to_indices(offsets, "offsets"),
                                                           to_numbers(radii, "radii"))
                       : std::make_unique<DeviceProximity>(
                             make_device(device), to_indices(offsets, "offsets"),
                             to_numbers(radii, "radii"), to_indices(candidates, "candidates"))) {}

  void update(const py::object& points) {
    if (const auto on_device =
            DevicePoints::of(points, proximity_->gpu().has_value(), proximity_->point_count())) {
      alone([&](DeviceProximity& proximity) {
        if (on_device->is_single) {
          proximity.update(reinterpret_cast<const float*>(on_device->address));
        } else {
          proximity.update(reinterpret_cast<const double*>(on_device->address));
        }
      });
      return;
    }
    const Doubles on_host = to_point_array(points, "points");
    require_count(on_host);
    const double* const coordinates = on_host.data();
    alone([&](DeviceProximity& proximity) { proximity.update_from_host(coordinates); });
  }

  /// @param points an array that is read where it lies
  std::shared_ptr<void> lock(const Doubles& points) {
    require_count(points);
    const double* const coordinates = points.data();
    return alone(
        [&](const DeviceProximity& proximity) { return proximity.lock_points(coordinates); });
  }
  /// Lets go of what lock() has given, when nobody reads it.
  void release(std::shared_ptr<void>& lock) {
    alone([&](const DeviceProximity& /*proximity*/) { lock.reset(); });
  }

  DeviceProximity::Contacts query_to_host(const DeviceProximity::Options& options) {
    return alone(
        [&](const DeviceProximity& proximity) { return proximity.query_to_host(options); });
  }
  DeviceProximity::Contacts query(const DeviceProximity::Options& options) {
    return alone([&](const DeviceProximity& proximity) { return proximity.query(options); });
  }

  py::array_t<bool> check(const DeviceProximity::Options& options) {
    std::vector<std::uint8_t> touching;
    alone([&](const DeviceProximity& proximity) { proximity.check_candidates(options, touching); });
    py::array_t<bool> answer(static_cast<Py_ssize_t>(touching.size()));
    std::copy(touching.begin(), touching.end(), answer.mutable_data());
    return answer;
  }

  void copy_to_host(const DeviceProximity::Contacts& contacts,
                    DeviceProximity::HostContacts& copy) {
    alone([&](const DeviceProximity& proximity) { proximity.copy_to_host(contacts, copy); });
  }

  std::optional<int> gpu() const { return proximity_->gpu(); }
  std::size_t candidate_count() const { return proximity_->candidate_count(); }
  double device_seconds() {
    return alone([](const DeviceProximity& proximity) { return proximity.device_seconds(); });
  }
  py::dict device_stages() {
    py::dict stages;
    for (const DeviceProximity::Stage& stage :
         alone([](const DeviceProximity& proximity) { return proximity.device_stages(); })) {
      stages[py::str(stage.name)] = stage.seconds;
    }
    return stages;
  }

 private:
  /// Calls while no other thread does, and lets others have Python.
  template <class Call>
  std::invoke_result_t<const Call&, DeviceProximity&> alone(const Call& call) {
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    return call(*proximity_);
  }

  void require_count(const Doubles& points) const {
    if (static_cast<std::size_t>(points.shape(0)) != proximity_->point_count()) {
      throw std::invalid_argument("there are " + std::to_string(points.shape(0)) +
                                  " points, the fibres have " +
                                  std::to_string(proximity_->point_count()));
    }
  }

  std::unique_ptr<DeviceProximity> proximity_;
  std::mutex mutex_;
};

}  // namespace fiber::python
