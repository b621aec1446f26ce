#include "fiber_proximity/hierarchy/space_curve.hpp"

#include <algorithm>

namespace fiber {
namespace {

constexpr double cells = 0x1FFFFF;  // 21 bits an axis fill 63 of a key

/// Two zero bits behind every bit.
std::uint64_t spread(std::uint64_t bits) {
  bits = (bits | bits << 32U) & 0x001F'0000'0000'FFFFU;
  bits = (bits | bits << 16U) & 0x001F'0000'FF00'00FFU;
  bits = (bits | bits << 8U) & 0x100F'00F0'0F00'F00FU;
  bits = (bits | bits << 4U) & 0x10C3'0C30'C30C'30C3U;
  return (bits | bits << 2U) & 0x1249'2492'4924'9249U;
}

}  // namespace

SpaceCurve::SpaceCurve(const std::vector<Eigen::Vector3d>& points) {
  if (points.empty()) {
    return;
  }
  lower_ = points.front();
  Eigen::Vector3d upper = points.front();
  for (const Eigen::Vector3d& point : points) {
    lower_ = lower_.cwiseMin(point);
    upper = upper.cwiseMax(point);
  }
  const double extent = (upper - lower_).maxCoeff();
  cells_per_metre_ = extent > 0.0 ? std::min(cells / extent, 1e300) : 0.0;
}

std::uint64_t SpaceCurve::key(const Eigen::Vector3d& point) const {
  std::uint64_t result = 0;
  for (int axis = 0; axis < 3; ++axis) {
    const double cell = std::clamp((point[axis] - lower_[axis]) * cells_per_metre_, 0.0, cells);
    result |= spread(static_cast<std::uint64_t>(cell)) << static_cast<unsigned>(axis);
  }
  return result;
}

}  // namespace fiber
