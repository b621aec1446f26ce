#pragma once

#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "src/cuda/find_pairs.hpp"
#include "src/cuda/host_fibers.hpp"
#include "src/cuda/judge_pairs.hpp"

namespace fiber {

/// Which points start segments, and of which fibre; changes with the topology only.
struct HostTopology {
  std::vector<std::uint32_t> first_points;
  std::vector<std::uint32_t> fibers;  ///< by point
  // Where there are candidates, as CandidateView has them.
  std::vector<std::uint32_t> candidates_of_fibers;
  std::vector<std::uint32_t> candidate_points;
  std::vector<std::uint32_t> candidate_segments;
};

/// Contacts in memory of the device, or of the host.
struct DeviceContacts {
  std::uint32_t count = 0;
  ContactArrays arrays = {};
  const std::uint32_t* candidate_begins = nullptr;  ///< none where there are no candidates
  std::shared_ptr<const void> memory;               ///< contacts stay as long as it is held
};

/// One of the things that a device does one after the other.
struct DeviceStage {
  const char* name;
  double seconds;  ///< [s]
};

/// A tree over the segments of fibres, on a device.
class DeviceTree {
 public:
  DeviceTree() = default;
  virtual ~DeviceTree() = default;
  DeviceTree(const DeviceTree&) = delete;
  DeviceTree& operator=(const DeviceTree&) = delete;

  virtual void set_topology(const HostTopology& topology) = 0;

  /// Builds it anew for points of this topology, and needs them no longer. Page-locked ones the
  /// device reads by itself.
  /// @throws std::invalid_argument for coordinates that are not finite or too large
  virtual void update(const HostFibers& fibers) = 0;

  /// Updates to points that are on the device already; waits until they are written.
  /// @param fibers all but its coordinates
  /// @param coordinates three per point [m]
  /// @throws std::invalid_argument for a pointer that is not of this device, too
  virtual void update(const HostFibers& fibers, const double* coordinates) = 0;
  virtual void update(const HostFibers& fibers, const float* coordinates) = 0;

  virtual const SegmentTreeView& view() const = 0;
  virtual const TreePoints& points() const = 0;
  virtual const std::uint32_t* fibers_by_point() const = 0;
  virtual const CandidateView& candidates() const = 0;
  virtual std::size_t point_count() const = 0;

  /// [bytes] of the device
  virtual std::size_t memory_bytes() const = 0;

  /// What the last update took on the device, once the points were there.
  virtual std::vector<DeviceStage> stages() const = 0;
};

/// [s] What stages took together.
inline double seconds_of(const std::vector<DeviceStage>& stages) {
  double sum = 0.0;
  for (const DeviceStage& stage : stages) {
    sum += stage.seconds;
  }
  return sum;
}

/// Where trees are built and pairs are found: a GPU, or this processor in its place.
class Device {
 public:
  Device() = default;
  virtual ~Device() = default;
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  virtual std::unique_ptr<DeviceTree> make_tree() = 0;

  /// Finds the pairs of some leaves of a with b. Calls must not overlap.
  /// @param most pairs there may be
  /// @param keys in ascending order; none if there are more
  /// @return how many there are
  virtual std::uint64_t find(const DeviceTree& a, std::uint32_t first_leaf,
                             std::uint32_t leaf_count, const DeviceTree& b, const PairRule& rule,
                             std::uint64_t most, std::vector<std::uint64_t>& keys) = 0;

  /// Finds the contacts of a tree's segments with each other, and leaves them on the device.
  /// @param margin [m] finite
  /// @throws std::runtime_error for more pairs than can be sorted
  virtual DeviceContacts contacts(const DeviceTree& tree, const PairRule& rule, double margin) = 0;

  /// The same in page-locked memory of the host.
  virtual DeviceContacts contacts_to_host(const DeviceTree& tree, const PairRule& rule,
                                          double margin) = 0;

  /// Which candidates of a tree have contacts.
  /// @param needs_loops whether contacts of a fibre with itself are none without a loop
  /// @param touching by candidate, 1 or 0
  /// @param asked contacts of a fibre with itself that may have a loop, of candidates that are not
  ///              known to touch anything else: their keys
  /// @throws as contacts()
  virtual void touching(const DeviceTree& tree, const PairRule& rule, double margin,
                        bool needs_loops, std::vector<std::uint32_t>& touching,
                        std::vector<std::uint64_t>& asked) = 0;

  /// Brings some points of a tree to the host, in this order.
  /// @param to room for three coordinates each [m]
  virtual void read_points(const DeviceTree& tree, const std::vector<std::uint32_t>& points,
                           double* to) = 0;

  /// Locks pages of the host for as long as the result is held, so that the device reads what is in
  /// them by itself.
  /// @throws std::invalid_argument if they are locked already, std::runtime_error where they cannot
  ///         be
  virtual std::shared_ptr<void> lock_pages(const void* data, std::size_t bytes) = 0;

  /// Memory of the device with these bytes in it, for as long as it is held.
  virtual std::shared_ptr<void> make_array(const void* from, std::size_t bytes) = 0;
  /// Copies from the device.
  virtual void read(const void* from, std::size_t bytes, void* to) = 0;

  /// Which GPU it is, as CUDA counts them; nothing for this processor.
  virtual std::optional<int> gpu() const = 0;

  /// [bytes] that pairs take, beside trees
  virtual std::size_t memory_bytes() const = 0;

  /// What the last find(), contacts() or touching() took on the device.
  virtual std::vector<DeviceStage> stages() const = 0;
};

/// Kernels as loops on this processor: the same answers without a GPU, for tests and trials.
FIBER_PROXIMITY_EXPORT std::unique_ptr<Device> make_host_device();

/// Why GPUs cannot be asked: that their part of the engine is not installed. Empty if it is.
FIBER_PROXIMITY_EXPORT const std::string& missing_cuda();

/// The GPU that is CUDA's current one in this thread: the first, where the program has chosen none.
/// @throws std::runtime_error if there is none that serves, saying what was looked for, and where
///         missing_cuda() says something
FIBER_PROXIMITY_EXPORT std::unique_ptr<Device> make_cuda_device();

}  // namespace fiber
