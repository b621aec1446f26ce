#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

namespace fiber {

/// Morton's space-filling curve through the bounding box of some points: positions along it put
/// what is near in space near in order.
class SpaceCurve {
 public:
  explicit SpaceCurve(const std::vector<Eigen::Vector3d>& points);

  /// Position of a point of the box along the curve.
  std::uint64_t key(const Eigen::Vector3d& point) const;

 private:
  Eigen::Vector3d lower_ = Eigen::Vector3d::Zero();
  double cells_per_metre_ = 0.0;
};

}  // namespace fiber
