#pragma once

#include "src/bounds/aabb.hpp"

namespace fiber {

/// The smallest cube along the axes of the world around a box.
struct Cube {
  using Parameters = NoParameters;

  Aabb box;  ///< all of its sides are equally long
};

/// Whatever is rounded on the way, the box stays inside.
inline Cube cube_around(const Aabb& box) {
  float side = 0.0F;
  for (int axis = 0; axis < 3; ++axis) {
    side = std::max(side, box.upper[axis] - box.lower[axis]);
  }
  Cube cube{box};
  for (int axis = 0; axis < 3 && std::isfinite(side); ++axis) {
    const float middle = 0.5F * box.lower[axis] + 0.5F * box.upper[axis];
    cube.box.lower[axis] = std::min(box.lower[axis], middle - 0.5F * side);
    cube.box.upper[axis] = std::max(box.upper[axis], middle + 0.5F * side);
  }
  return cube;
}

inline void fit(Cube& cube, const Capsule& capsule, const NoParameters& parameters) {
  fit(cube.box, capsule, parameters);
  cube = cube_around(cube.box);
}

inline void fit(Cube& cube, const CapsuleRun& run, const NoParameters& parameters) {
  fit(cube.box, run, parameters);
  cube = cube_around(cube.box);
}

inline Cube merge(const Cube& a, const Cube& b) { return cube_around(merge(a.box, b.box)); }

inline bool overlaps(const Cube& a, const Cube& b, float margin) {
  return overlaps(a.box, b.box, margin);
}

inline float distance_lower_bound(const Cube& a, const Cube& b) {
  return distance_lower_bound(a.box, b.box);
}

inline bool contains(const Cube& cube, const Capsule& capsule, const NoParameters& parameters) {
  return contains(cube.box, capsule, parameters);
}

inline double volume(const Cube& cube, const NoParameters& parameters) {
  return volume(cube.box, parameters);
}

inline const Aabb& bounding_box(const Cube& cube, const NoParameters& /*parameters*/) {
  return cube.box;
}

/// A cube has no longest side: those of the box around the capsules.
inline std::vector<SplitAxis> split_axes(const Cube& /*cube*/, const CapsuleRun& run,
                                         const NoParameters& parameters) {
  Aabb box;
  fit(box, run, parameters);
  return split_axes(box, run, parameters);
}

static_assert(IsBoundingVolume<Cube>::value, "Cube must keep the contract");

}  // namespace fiber
