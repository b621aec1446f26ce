#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// Cubic cells that are occupied, in an octree; never changes once it is made, so that any number
/// of threads may ask at once. The signed distance is that of the nearest cell, so that inside it
/// is never below minus half a cell.
class OccupancyOctree {
 public:
  /// All cells that hold one of the points at least.
  /// @param resolution [m] edge of a cell, > 0
  /// @param points     [m] those beyond 32767 cells from the origin are left out and counted
  /// @throws std::invalid_argument for a resolution that is not positive and finite
  OccupancyOctree(double resolution, const std::vector<Eigen::Vector3d>& points);
  OccupancyOctree(const OccupancyOctree&) = delete;
  OccupancyOctree& operator=(const OccupancyOctree&) = delete;

  double resolution() const { return resolution_; }  ///< [m]
  std::size_t cell_count() const { return centres_.size(); }
  std::size_t left_out_count() const {
    return left_out_;
  }  ///< points that are not finite or too far
  const std::vector<Eigen::Vector3d>& centres() const { return centres_; }  ///< of the cells [m]
  const WorldBox& box() const { return box_; }  ///< around the cells, in their frame [m]

  /// Infinitely far if nothing is within the bound [m].
  AxisDistance axis_distance(const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                             double bound) const;

  /// Calls visit(centre) for the cells within so much [m] of a box, in an order that depends on
  /// nothing else.
  void visit_near(const WorldBox& box, double within,
                  const std::function<void(const Eigen::Vector3d&)>& visit) const;

 private:
  double resolution_;  // [m]
  // Of the cells along Morton's curve, ascending: cubes of the octree are ranges of them.
  std::vector<std::uint64_t> codes_;
  std::vector<Eigen::Vector3d> centres_;
  WorldBox box_;
  std::size_t left_out_ = 0;
};

}  // namespace fiber
