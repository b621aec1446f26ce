#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// Cubic cells that are occupied, in an octree; never changes once it is made, so that any number
/// of threads may ask at once. The signed distance is that of the nearest cell, so that inside it
/// is never below minus half a cell.
class OccupancyOctree {
 public:
  /// Cells along an axis on either side of the origin.
  static constexpr int half_of_cells = 1 << 15;

  /// A cell's place on Morton's curve.
  using Cell = std::uint64_t;

  /// The cell of this edge [m] that holds a point [m]; none of a point that is not finite, or
  /// further than `half_of_cells` from the origin.
  static std::optional<Cell> cell_at(double resolution, const Eigen::Vector3d& point);

  /// @param resolution [m] edge of a cell, > 0
  /// @param cells      those that are occupied, in any order
  /// @throws std::invalid_argument for a resolution that is not positive and finite
  OccupancyOctree(double resolution, std::vector<Cell> cells);
  OccupancyOctree(const OccupancyOctree&) = delete;
  OccupancyOctree& operator=(const OccupancyOctree&) = delete;

  double resolution() const { return resolution_; }                         ///< [m]
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
  // Places of the cells along Morton's curve, ascending: cubes of the octree are ranges of them.
  std::vector<Cell> cells_;
  std::vector<Eigen::Vector3d> centres_;
  WorldBox box_;
};

}  // namespace fiber
