#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <limits>

#include "fiber_proximity/geometry/capsule.hpp"

namespace fiber {

/// A run of consecutive capsules in memory: what a wrapped or spatial node encloses.
struct CapsuleRun {
  const Capsule* first = nullptr;
  std::size_t size = 0;

  const Capsule* begin() const { return first; }
  const Capsule* end() const { return first + size; }
};

/// A capsule in single precision, and by how much a volume around it must be padded so that its
/// tests err on the safe side only.
///
/// With u = 2⁻²⁴, rounding an end point, projecting it onto a rounded unit direction, adding the
/// radius and subtracting two such numbers err by less than 12 u of the largest magnitude involved;
/// the padding is 16 u of it: a micrometre in a scene of a metre. It covers the rounding of the
/// narrow phase in double precision many times over. The smallest normal float keeps it alive where
/// the product would underflow.
struct RoundedCapsule {
  /// Magnitudes up to here have squares and sums of squares in float's range [m].
  static constexpr double largest_magnitude = 1e18;

  Eigen::Vector3f p0;
  Eigen::Vector3f p1;
  float radius = 0.0F;   ///< [m]
  float padding = 0.0F;  ///< [m]

  /// False beyond largest_magnitude: a volume must then enclose everything.
  bool representable = false;

  explicit RoundedCapsule(const Capsule& capsule)
      : p0(Eigen::Vector3f::Zero()), p1(Eigen::Vector3f::Zero()) {
    const double magnitude =
        std::max(capsule.p0.cwiseAbs().maxCoeff(), capsule.p1.cwiseAbs().maxCoeff()) +
        capsule.radius;
    representable = magnitude <= largest_magnitude;
    if (!representable) {
      return;
    }
    p0 = capsule.p0.cast<float>();
    p1 = capsule.p1.cast<float>();
    radius = static_cast<float>(capsule.radius);
    padding = static_cast<float>(magnitude) * 0x1p-20F + std::numeric_limits<float>::min();
  }
};

/// What squares below the normal range of float may err by, as their digits run out [m²].
constexpr float squared_underflow = std::numeric_limits<float>::min();

}  // namespace fiber
