#include "src/geometry/smallest_rotation.hpp"

#include <cassert>
#include <cmath>

#include "src/geometry/norm.hpp"

namespace fiber {

using Eigen::Vector3d;

Eigen::Quaterniond smallest_rotation(const Vector3d& from, const Vector3d& to) {
  const Vector3d u = unit_of(from);
  const Vector3d v = unit_of(to);
  assert(!u.isZero(0.0) && !v.isZero(0.0));
  const double cosine = u.dot(v);
  const Vector3d cross = u.cross(v);
  Eigen::Quaterniond rotation;
  if (cosine >= 0.0) {
    // Half of the angle: cos² = (1 + cosine) / 2, and sin·cos = |cross| / 2.
    const double cos_half = std::sqrt(0.5 * (1.0 + cosine));
    rotation.w() = cos_half;
    rotation.vec() = cross / (2.0 * cos_half);
  } else {
    const double sine = norm_of(cross);
    // Where the cross product has few digits left, it may not be at right angles to them.
    Vector3d axis = sine > 0.0 ? unit_of(cross) : u.unitOrthogonal();
    axis = unit_of(axis - axis.dot(u) * u);
    const double sin_half = std::sqrt(0.5 * (1.0 - cosine));
    rotation.w() = sine / (2.0 * sin_half);
    rotation.vec() = sin_half * axis;
  }
  rotation.normalize();
  return rotation;
}

}  // namespace fiber
