#pragma once

#include <Eigen/Core>
#include <cmath>

namespace fiber {

/// The head that the hair styles grow on: an ellipsoid at the origin; x forward, y left, z up.
struct Head {
  /// Half its length, width and height [m].
  static constexpr double semi_axes[3] = {0.095, 0.075, 0.115};

  /// Most hairs that find a place at 200 per cm²: 650 cm² of scalp, the paper's "up to 130 000".
  static constexpr unsigned most_hairs = 130'000;

  /// The image of the point when the head becomes the unit sphere.
  static Eigen::Vector3d to_sphere(const Eigen::Vector3d& point) {
    return {point.x() / semi_axes[0], point.y() / semi_axes[1], point.z() / semi_axes[2]};
  }
  static Eigen::Vector3d from_sphere(const Eigen::Vector3d& point) {
    return {point.x() * semi_axes[0], point.y() * semi_axes[1], point.z() * semi_axes[2]};
  }

  /// Size of the concentric, similar ellipsoid through the point: 1 on the skin, less inside.
  static double level(const Eigen::Vector3d& point);

  /// The point itself, or moved away from the centre to this level if it lies below.
  static Eigen::Vector3d lifted(const Eigen::Vector3d& point, double least_level);

  /// Unit normal of the ellipsoid through the point, outwards.
  static Eigen::Vector3d normal(const Eigen::Vector3d& point);
};

}  // namespace fiber
