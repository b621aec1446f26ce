#pragma once

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "src/bounds/bounding_volume.hpp"

namespace fiber {

/// Four floats that every 64-bit machine computes at once: a feature of GCC and Clang that needs no
/// instruction set beyond the target's own. Read and set its values by index.
using Float4 = float __attribute__((vector_size(16)));

inline Float4 min(Float4 a, Float4 b) { return a < b ? a : b; }
inline Float4 max(Float4 a, Float4 b) { return a < b ? b : a; }

/// Axis-aligned bounding box (paper, Sect. 4.1), the hand-optimised 6-DOP.
struct Aabb {
  using Parameters = NoParameters;

  Float4 lower{};  ///< [m] relative to the hierarchy's origin; the fourth value is no coordinate
  Float4 upper{};  ///< the same; the fourth value is at least lower's
};

inline void fit(Aabb& box, const Capsule& capsule, const NoParameters& /*parameters*/) {
  const RoundedCapsule rounded(capsule);
  const float reach = rounded.representable ? rounded.radius + rounded.padding
                                            : std::numeric_limits<float>::infinity();
  const Float4 p0{rounded.p0.x(), rounded.p0.y(), rounded.p0.z(), 0.0F};
  const Float4 p1{rounded.p1.x(), rounded.p1.y(), rounded.p1.z(), 0.0F};
  box.lower = min(p0, p1) - reach;
  box.upper = max(p0, p1) + reach;
}

inline Aabb merge(const Aabb& a, const Aabb& b) {
  return {min(a.lower, b.lower), max(a.upper, b.upper)};
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
  const Float4 gap = max(max(a.lower - b.upper, b.lower - a.upper), Float4{});
  const Float4 squared = gap * gap;
  return squared[0] + squared[1] + squared[2];
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
