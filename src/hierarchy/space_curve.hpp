#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// Hilbert's space-filling curve through the bounding box of some points: positions along it put
/// what is near in space near in order. Neighbours on it are neighbours in space, which Morton's
/// curve, with its jumps, does not offer (docs/performance.md).
class FIBER_PROXIMITY_EXPORT SpaceCurve {
 public:
  explicit SpaceCurve(const std::vector<Eigen::Vector3d>& points);

  /// Positions of the middles of segments, by their first points: the position along the curve in
  /// the upper 32 bits, the first point in the lower ones, so that all keys differ.
  void key_segments(const std::vector<Eigen::Vector3d>& points, const std::uint32_t* first_points,
                    std::size_t count, std::uint64_t* keys) const;

 private:
  Eigen::Vector3d lower_ = Eigen::Vector3d::Zero();
  double cells_per_metre_ = 0.0;
};

}  // namespace fiber
