#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// Eight boxes, of which the distances from another one are found at once.
class EightBoxes {
 public:
  static constexpr Eigen::Index count = 8;
  using Distances = Eigen::Array<double, count, 1>;

  void set(Eigen::Index index, const WorldBox& box) {
    lower_.row(index) = box.min().transpose();
    upper_.row(index) = box.max().transpose();
  }

  /// [m²] By box; those that were not set are points at the origin.
  Distances squared_distances(const WorldBox& box) const {
    Distances squared = Distances::Zero();
    for (Eigen::Index axis = 0; axis < 3; ++axis) {
      const auto below = lower_.col(axis) - box.max()[axis];
      const auto above = box.min()[axis] - upper_.col(axis);
      squared += below.max(above).max(0.0).square();
    }
    return squared;
  }

 private:
  using Corners = Eigen::Array<double, count, 3>;

  Corners lower_ = Corners::Zero();
  Corners upper_ = Corners::Zero();
};

/// How far boxes may be apart, as their squared distances tell. Those that overlap are always near.
class BoxReach {
 public:
  /// @param within [m]
  explicit BoxReach(double within) {
    const double distance = std::max(within, 0.0);
    // More by the rounding of squares, and by that of those which are too small for it.
    squared_ = distance * distance * (1.0 + 0x1p-40) + std::numeric_limits<double>::min();
  }

  bool holds(double squared_distance) const { return squared_distance <= squared_; }

 private:
  double squared_;  // [m²]
};

}  // namespace fiber
