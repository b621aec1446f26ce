#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "fiber_proximity/bounds/bounding_volume.hpp"

namespace fiber {

/// Axis-aligned bounding box (paper, Sect. 4.1), the hand-optimised 6-DOP.
struct Aabb {
  std::array<float, 3> lower{};  ///< [m] relative to the hierarchy's origin
  std::array<float, 3> upper{};  ///< [m] relative to the hierarchy's origin
};

/// Relative padding of a box by the largest magnitude in it. A float conversion, a subtraction and
/// a squared norm together err by less than 8 units of 2⁻²⁴ of that magnitude; 2⁻²⁰ is twice that,
/// and a micrometre in a scene of a metre.
constexpr float aabb_padding = 0x1p-20F;

inline void fit(Aabb& box, const Capsule& capsule) {
  std::array<double, 3> lower{};
  std::array<double, 3> upper{};
  double magnitude = 0.0;
  for (int axis = 0; axis < 3; ++axis) {
    lower[axis] = std::min(capsule.p0[axis], capsule.p1[axis]) - capsule.radius;
    upper[axis] = std::max(capsule.p0[axis], capsule.p1[axis]) + capsule.radius;
    magnitude = std::max(magnitude, std::max(-lower[axis], upper[axis]));
  }
  // The smallest normal float keeps the padding alive where the product would underflow.
  constexpr float largest = std::numeric_limits<float>::max();
  const float padding =
      static_cast<float>(magnitude) * aabb_padding + std::numeric_limits<float>::min();
  for (int axis = 0; axis < 3; ++axis) {
    // Beyond float's range the box opens to infinity; the clamp keeps ∞ − ∞ out.
    box.lower[axis] = std::min(static_cast<float>(lower[axis]), largest) - padding;
    box.upper[axis] = std::max(static_cast<float>(upper[axis]), -largest) + padding;
  }
}

inline Aabb merge(const Aabb& a, const Aabb& b) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::min(a.lower[axis], b.lower[axis]);
    box.upper[axis] = std::max(a.upper[axis], b.upper[axis]);
  }
  return box;
}

/// Squared distance of the boxes [m²], 0 when they overlap.
inline float squared_distance(const Aabb& a, const Aabb& b) {
  float sum = 0.0F;
  for (int axis = 0; axis < 3; ++axis) {
    const float gap = std::max(a.lower[axis] - b.upper[axis], b.lower[axis] - a.upper[axis]);
    const float outside = std::max(gap, 0.0F);
    sum += outside * outside;
  }
  return sum;
}

/// What squares below the normal range of float may err by, as their digits run out [m²].
constexpr float squared_underflow = std::numeric_limits<float>::min();

inline bool overlaps(const Aabb& a, const Aabb& b, float margin) {
  return squared_distance(a, b) <= margin * margin + squared_underflow;
}

inline float distance_lower_bound(const Aabb& a, const Aabb& b) {
  const float squared = squared_distance(a, b) - squared_underflow;
  return std::sqrt(std::clamp(squared, 0.0F, std::numeric_limits<float>::max()));
}

/// The axis-aligned box around a volume, for drawing.
inline const Aabb& bounding_box(const Aabb& box) { return box; }

static_assert(IsBoundingVolume<Aabb>::value, "Aabb must keep the contract of bounding volumes");

}  // namespace fiber
