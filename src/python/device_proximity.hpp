#pragma once

#include <pybind11/stl.h>

#include <algorithm>
#include <memory>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
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
      const WithoutPythonLock others_may_run;
      const std::lock_guard<std::mutex> lock(mutex_);
      if (on_device->is_single) {
        proximity_->update(reinterpret_cast<const float*>(on_device->address));
      } else {
        proximity_->update(reinterpret_cast<const double*>(on_device->address));
      }
      return;
    }
    const Doubles on_host = to_point_array(points, "points");
    require_count(on_host);
    const double* const coordinates = on_host.data();
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    proximity_->update_from_host(coordinates);
  }

  /// @param points an array that is read where it lies
  std::shared_ptr<void> lock(const Doubles& points) {
    require_count(points);
    const double* const coordinates = points.data();
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    return proximity_->lock_points(coordinates);
  }

  DeviceProximity::Contacts query_to_host(const DeviceProximity::Options& options) {
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    return proximity_->query_to_host(options);
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
  py::dict device_stages() const {
    py::dict stages;
    for (const DeviceProximity::Stage& stage : proximity_->device_stages()) {
      stages[py::str(stage.name)] = stage.seconds;
    }
    return stages;
  }

 private:
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
