#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <vector>

#include "fiber_proximity/bounds/bounding_volume.hpp"

namespace fiber {

/// Axis-aligned bounding box (paper, Sect. 4.1), the hand-optimised 6-DOP.
struct Aabb {
  using Parameters = NoParameters;

  std::array<float, 3> lower{};  ///< [m] relative to the hierarchy's origin
  std::array<float, 3> upper{};  ///< [m] relative to the hierarchy's origin
};

inline void fit(Aabb& box, const Capsule& capsule, const NoParameters& /*parameters*/) {
  const RoundedCapsule rounded(capsule);
  const float reach = rounded.representable ? rounded.radius + rounded.padding
                                            : std::numeric_limits<float>::infinity();
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = std::min(rounded.p0[axis], rounded.p1[axis]) - reach;
    box.upper[axis] = std::max(rounded.p0[axis], rounded.p1[axis]) + reach;
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

inline void fit(Aabb& box, const CapsuleRun& run, const NoParameters& parameters) {
  fit(box, *run.first, parameters);
  for (const Capsule& capsule : run) {
    Aabb other;
    fit(other, capsule, parameters);
    box = merge(box, other);
  }
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

inline bool overlaps(const Aabb& a, const Aabb& b, float margin) {
  return squared_distance(a, b) <= margin * margin + squared_underflow;
}

inline float distance_lower_bound(const Aabb& a, const Aabb& b) {
  return std::sqrt(std::max(squared_distance(a, b) - squared_underflow, 0.0F));
}

inline bool contains(const Aabb& box, const Capsule& capsule, const NoParameters& /*parameters*/) {
  for (int axis = 0; axis < 3; ++axis) {
    const double low = std::min(capsule.p0[axis], capsule.p1[axis]) - capsule.radius;
    const double high = std::max(capsule.p0[axis], capsule.p1[axis]) + capsule.radius;
    if (low < static_cast<double>(box.lower[axis]) || high > static_cast<double>(box.upper[axis])) {
      return false;
    }
  }
  return true;
}

inline double volume(const Aabb& box, const NoParameters& /*parameters*/) {
  double product = 1.0;
  for (int axis = 0; axis < 3; ++axis) {
    product *= static_cast<double>(box.upper[axis]) - static_cast<double>(box.lower[axis]);
  }
  return product;
}

inline const Aabb& bounding_box(const Aabb& box, const NoParameters& /*parameters*/) { return box; }

/// The three axes of a box, longest first; the first of equals keeps its place.
inline std::vector<SplitAxis> split_axes(const Aabb& box, const CapsuleRun& /*run*/,
                                         const NoParameters& /*parameters*/) {
  std::vector<SplitAxis> axes;
  for (int axis = 0; axis < 3; ++axis) {
    const auto low = static_cast<double>(box.lower[axis]);
    const auto high = static_cast<double>(box.upper[axis]);
    axes.push_back({Eigen::Vector3d::Unit(axis), 0.5 * (low + high), high - low});
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const SplitAxis& x, const SplitAxis& y) { return x.extent > y.extent; });
  return axes;
}

static_assert(IsBoundingVolume<Aabb>::value, "Aabb must keep the contract of bounding volumes");

}  // namespace fiber
