#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/query/options.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

class Device;
struct PairRule;

/// Contacts of fibres whose points are on a GPU, left there: for simulations whose points never
/// come to the host. Pairs, parameters and distances are those of every engine, bit for bit.
///
/// Fibres may be candidates, as check_fibers() has them, thousands in one assembly: places where a
/// planner might put cables. A candidate meets itself, and fibres that stand still; the others it
/// does not know, wherever they are.
///
/// Calls to one object, the const ones as well, must not overlap: they share its memory. Several
/// objects may be used at once.
class DeviceProximity {
 public:
  /// Which pairs are contacts.
  struct Options {
    double margin = 0.0;  ///< [m] finite, >= 0
    /// As PairOptions has it. No value asks the rule of loops, which check_candidates() knows.
    std::optional<std::uint32_t> neighbour_skip = 1;
    Pairing pairing = Pairing::ALL;  ///< not of pairs with what stands still
    bool with_itself = true;         ///< candidates: contacts of each with itself count
  };

  /// Arrays of `count` values each, sorted by a, then b: of query() on the device, of
  /// query_to_host() in memory of the host. They stay as they are as long as `memory` is held; a
  /// query while it is held takes other memory.
  struct Contacts {
    std::uint32_t count = 0;
    const std::uint32_t* a = nullptr;  ///< first points of the segments, a < b
    const std::uint32_t* b = nullptr;
    const double* s = nullptr;  ///< where on segment a, 0 at its first point and 1 at its second
    const double* t = nullptr;  ///< where on segment b
    const double* distance = nullptr;  ///< signed gap of the surfaces, negative in penetration [m]
    /// Candidate count + 1 values: which contact is the first of each candidate, and how many there
    /// are; null without candidates.
    const std::uint32_t* candidate_begins = nullptr;
    std::shared_ptr<const void> memory;
  };

  /// The same in memory of the caller: 32 bytes each.
  struct HostContacts {
    std::vector<std::uint32_t> a;
    std::vector<std::uint32_t> b;
    std::vector<double> s;
    std::vector<double> t;
    std::vector<double> distance;
    std::vector<std::uint32_t> candidate_begins;
  };

  /// One of the things that the device does one after the other.
  struct Stage {
    std::string name;  ///< points, bounds, order, tree; pairs, order of pairs, contacts
    double seconds;    ///< [s]
  };

  /// @param offsets fibre count + 1 values, from 0 to the number of points, on the host
  /// @param radii   [m] one for all fibres, one per fibre, or one per point, on the host
  /// @throws std::invalid_argument as FiberAssembly, std::runtime_error without a GPU that serves
  DeviceProximity(std::vector<std::uint32_t> offsets, std::vector<double> radii);
  /// With candidates.
  /// @param candidates candidate count + 1 values, from 0 on: fibres candidates[c] …
  ///                   candidates[c + 1] − 1 are candidate c, and those from the last value on
  ///                   stand still
  DeviceProximity(std::vector<std::uint32_t> offsets, std::vector<double> radii,
                  std::vector<std::uint32_t> candidates);
  /// On another device than the GPU, for tests and trials.
  DeviceProximity(std::unique_ptr<Device> device, std::vector<std::uint32_t> offsets,
                  std::vector<double> radii);
  DeviceProximity(std::unique_ptr<Device> device, std::vector<std::uint32_t> offsets,
                  std::vector<double> radii, std::vector<std::uint32_t> candidates);
  ~DeviceProximity();
  DeviceProximity(const DeviceProximity&) = delete;
  DeviceProximity& operator=(const DeviceProximity&) = delete;

  std::size_t point_count() const { return offsets_.back(); }
  std::size_t candidate_count() const;

  /// Takes the points, and needs them no longer. Waits until all that the device has been given
  /// before is done.
  /// @param coordinates on the device, three per point [m]
  /// @throws std::invalid_argument for a pointer that is not of this device, and for coordinates
  /// that
  ///         are not finite or above FiberAssembly::max_coordinate; there are no points then
  void update(const double* coordinates);
  void update(const float* coordinates);

  /// Updates to points on the host, looked at on the device. Those that are page-locked, by
  /// lock_points() or by CUDA, it reads by itself; others are copied on all threads.
  /// @throws std::invalid_argument for another number of points, and naming the first that cannot
  /// be
  void update_from_host(const std::vector<Eigen::Vector3d>& points);
  /// Updates to as many points as there are, in an array of others.
  /// @param coordinates on the host, three per point [m]
  /// @throws std::invalid_argument for a null pointer, too
  void update_from_host(const double* coordinates);

  /// Page-locks the memory of points that stay where they are from frame to frame, for as long as
  /// the result is held: they must be neither freed nor moved before it is let go. Takes as long as
  /// many frames.
  /// @throws std::invalid_argument if they are locked already, std::runtime_error where they cannot
  ///         be
  std::shared_ptr<void> lock_points(const std::vector<Eigen::Vector3d>& points) const;
  /// Locks an array that update_from_host() will take.
  std::shared_ptr<void> lock_points(const double* coordinates) const;

  /// Finds the contacts, and waits until they are there. Before, it waits until all that the device
  /// has been given is done: that may read contacts that were let go of.
  /// @throws std::invalid_argument for a margin that is not allowed and without neighbour_skip,
  ///         std::logic_error before the first update(), std::runtime_error where the device's
  ///         memory does not suffice, saying how much was needed
  Contacts query(const Options& options) const;

  /// Finds the contacts for the host: each part goes there while the device decides about the next,
  /// into page-locked memory, without a further copy. Waits as query() does.
  /// @throws as query()
  Contacts query_to_host(const Options& options) const;

  /// Copies contacts of a query() to the host, into the memory there is.
  void copy_to_host(const Contacts& contacts, HostContacts& copy) const;

  /// Which candidates have contacts, as check_fibers() says it: with themselves, or with what
  /// stands still. The first contact ends what is looked for of a candidate. Where the rule of
  /// loops is asked, the host decides about contacts of a fibre with itself that may have one, if
  /// their candidate has no others.
  /// @param touching by candidate, 1 or 0
  /// @throws as query(), std::logic_error without candidates
  void check_candidates(const Options& options, std::vector<std::uint8_t>& touching) const;

  /// Which GPU the arrays are on, as CUDA counts them; nothing where they are in memory of the
  /// host.
  std::optional<int> gpu() const;

  /// [s] What the last update() and the last query() or check_candidates() took on the device.
  double device_seconds() const;

  /// What of that each stage took, in their order.
  std::vector<Stage> device_stages() const;

 private:
  struct Tree;

  template <class Number>
  void take(const Number* coordinates);
  void take_topology(std::vector<double> radii, std::vector<std::uint32_t>* candidates);
  void require_count(const std::vector<Eigen::Vector3d>& points) const;
  PairRule rule_of(const Options& options) const;
  PairRule rule_of_contacts(const Options& options) const;

  std::vector<std::uint32_t> offsets_;
  std::unique_ptr<Device> device_;
  std::unique_ptr<Tree> tree_;
};

}  // namespace fiber
