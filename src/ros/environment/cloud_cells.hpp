#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <limits>
#include <memory>
#include <string>
#include <unordered_map>
#include <vector>

#include "fiber_proximity/environment/occupancy_octree.hpp"

namespace fiber_proximity_ros {

/// How a point cloud becomes an obstacle; the defaults are in cfg/interface.yaml.
struct CloudOptions {
  double resolution{};  ///< [m] edge of a cell; what depth cameras see at 2 m

  /// [m] In the fixed frame: points outside of it are left out.
  fiber::WorldBox box{Eigen::Vector3d::Constant(-std::numeric_limits<double>::infinity()),
                      Eigen::Vector3d::Constant(std::numeric_limits<double>::infinity())};

  double decay{};  ///< [s] cells seen within this time stay; 0: those of the newest cloud only

  bool required{};   ///< answers without a cloud are incomplete
  double timeout{};  ///< [s] from the last cloud on it counts as such; 0: never
};

/// How many points of a cloud became cells, and why others did not.
struct CloudCounts {
  std::size_t points = 0;
  std::size_t not_finite = 0;   ///< as cameras mark what they do not see
  std::size_t outside_box = 0;  ///< and so not wanted
  std::size_t too_far = 0;      ///< further than an octree of the resolution reaches

  /// Points that have become cells.
  std::size_t used() const { return points - not_finite - outside_box - too_far; }
};

/// Why points were not used, such as "3 are not finite, 1 is outside the box"; empty if all were.
std::string reasons_of(const CloudCounts& counts, double resolution);

/// The cells that clouds have occupied of late.
class CloudCells {
 public:
  /// @throws std::invalid_argument for a resolution that is not positive and finite, a decay that
  /// is
  ///         negative or not finite, or a box with a minimum above its maximum
  explicit CloudCells(const CloudOptions& options);

  /// Takes over one cloud and forgets what is older by more than the decay.
  /// @param pose of the cloud's frame in the fixed frame
  /// @param time [s] of the cloud; if it is earlier than the newest by more than the decay, time
  /// has
  ///        started again, and so do the cells
  CloudCounts add(const std::vector<Eigen::Vector3d>& points, const Eigen::Isometry3d& pose,
                  double time);

  /// Made anew with each call; null if there are no cells.
  std::shared_ptr<const fiber::OccupancyOctree> octree() const;

 private:
  void forget(double time);

  CloudOptions options_;
  std::unordered_map<fiber::OccupancyOctree::Cell, double> cells_;  // when each was seen last [s]
  double newest_ = -std::numeric_limits<double>::infinity();
};

}  // namespace fiber_proximity_ros
