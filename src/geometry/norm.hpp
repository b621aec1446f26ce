#pragma once

#include <Eigen/Core>

namespace fiber {

/// [m] Below this, squares of coordinates may lose digits or underflow.
constexpr double min_safe_norm = 0x1p-500;

/// Brings a vector of at most min_safe_norm, subnormal numbers included, to where its squares
/// have all their digits. A power of two: nothing is rounded.
constexpr double tiny_vector_scale = 0x1p600;

/// Length of a vector of any magnitude that an assembly may have [m].
template <class Derived>
double norm_of(const Eigen::MatrixBase<Derived>& v) {
  const double norm = v.norm();
  return norm > min_safe_norm ? norm : (v * tiny_vector_scale).norm() / tiny_vector_scale;
}

/// The vector of unit length in this direction, for any magnitude; zero for the zero vector.
inline Eigen::Vector3d unit_of(const Eigen::Vector3d& v) {
  const double norm = v.norm();
  return norm > min_safe_norm ? Eigen::Vector3d(v / norm) : (v * tiny_vector_scale).normalized();
}

}  // namespace fiber
