#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/query/options.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

class Device;
struct PairRule;

/// Contacts of fibres whose points are on a GPU, left there: for simulations whose points never
/// come to the host. Pairs, parameters and distances are those of every engine, bit for bit.
class DeviceProximity {
 public:
  /// Which pairs are contacts. The rule of loops is the host's: here neighbours are left out by
  /// their number.
  struct Options {
    double margin = 0.0;               ///< [m] finite, >= 0
    std::uint32_t neighbour_skip = 1;  ///< as PairOptions has it
    Pairing pairing = Pairing::ALL;
  };

  /// Arrays on the device of `count` values each, sorted by a, then b: to be read until the next
  /// query().
  struct Contacts {
    std::uint32_t count = 0;
    const std::uint32_t* a = nullptr;  ///< first points of the segments, a < b
    const std::uint32_t* b = nullptr;
    const double* s = nullptr;  ///< where on segment a, 0 at its first point and 1 at its second
    const double* t = nullptr;  ///< where on segment b
    const double* distance = nullptr;  ///< signed gap of the surfaces, negative in penetration [m]
  };

  /// The same arrays in memory of the host, of the object that has found them: to be read until its
  /// next query_to_host(), or its end.
  struct HostArrays {
    std::uint32_t count = 0;
    const std::uint32_t* a = nullptr;
    const std::uint32_t* b = nullptr;
    const double* s = nullptr;
    const double* t = nullptr;
    const double* distance = nullptr;
  };

  /// The same in memory of the caller: 32 bytes each.
  struct HostContacts {
    std::vector<std::uint32_t> a;
    std::vector<std::uint32_t> b;
    std::vector<double> s;
    std::vector<double> t;
    std::vector<double> distance;
  };

  /// @param offsets fibre count + 1 values, from 0 to the number of points, on the host
  /// @param radii   [m] one for all fibres, one per fibre, or one per point, on the host
  /// @throws std::invalid_argument as FiberAssembly, std::runtime_error without a GPU that serves
  DeviceProximity(std::vector<std::uint32_t> offsets, std::vector<double> radii);
  /// On another device than the GPU, for tests and trials.
  DeviceProximity(std::unique_ptr<Device> device, std::vector<std::uint32_t> offsets,
                  std::vector<double> radii);
  ~DeviceProximity();
  DeviceProximity(const DeviceProximity&) = delete;
  DeviceProximity& operator=(const DeviceProximity&) = delete;

  std::size_t point_count() const { return offsets_.back(); }

  /// Takes the points, and needs them no longer. Waits until all that the device has been given
  /// before is done.
  /// @param coordinates on the device, three per point [m]
  /// @throws std::invalid_argument for a pointer that is not of this device, and for coordinates
  /// that
  ///         are not finite or above FiberAssembly::max_coordinate; there are no points then
  void update(const double* coordinates);
  void update(const float* coordinates);

  /// The same of points on the host, looked at on the device. Those that are page-locked, by
  /// lock_points() or by CUDA, it reads by itself; others are copied on all threads.
  /// @throws std::invalid_argument for another number of points, and naming the first that cannot
  /// be
  void update_from_host(const std::vector<Eigen::Vector3d>& points);

  /// Page-locks the memory of points that stay where they are from frame to frame, for as long as
  /// the result is held: they must be neither freed nor moved before it is let go. Takes as long as
  /// many frames.
  /// @throws std::invalid_argument if they are locked already, std::runtime_error where they cannot
  ///         be
  std::shared_ptr<void> lock_points(const std::vector<Eigen::Vector3d>& points) const;

  /// Finds the contacts, and waits until they are there.
  /// @throws std::invalid_argument for a margin that is not allowed, std::logic_error before the
  /// first
  ///         update(), std::runtime_error where the device's memory does not suffice, saying how
  ///         much was needed
  Contacts query(const Options& options) const;

  /// Finds the contacts for the host: each part goes there while the device decides about the next,
  /// into page-locked memory of this object, without a further copy. Contacts of query() are gone.
  /// @throws as query()
  HostArrays query_to_host(const Options& options) const;

  /// Copies contacts of the last query() to the host, into the memory there is.
  void copy_to_host(const Contacts& contacts, HostContacts& copy) const;

  /// [s] What the last update() and the last query() took on the device.
  double device_seconds() const;

 private:
  struct Tree;

  template <class Number>
  void take(const Number* coordinates);
  PairRule rule_of(const Options& options) const;

  std::vector<std::uint32_t> offsets_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace fiber
