#pragma once

#include <array>

#include "src/environment/convex_solids.hpp"
#include "src/sim/contact/edge_part.hpp"

namespace fiber {

/// Parts of an edge, at most as many as a triangle has faces and edges, or a box directions of
/// them.
struct FlatParts {
  std::array<EdgePart, 6> parts;
  std::size_t count = 0;

  void add(const EdgePart& part) { parts[count++] = part; }
};

// The parts of an edge that lie over the flats of a convex solid: its flat faces, its straight
// edges, and the straight lines of round sides, in this order. Nowhere else can an edge touch in
// more than one point. What of an edge passes a flat counts as over that, however far away.
/// @param p0, p1 ends of the edge in the solid's frame [m]

FlatParts parts_over_flats(const BoxShape& box, const Eigen::Vector3d& p0,
                           const Eigen::Vector3d& p1);
FlatParts parts_over_flats(const CylinderShape& cylinder, const Eigen::Vector3d& p0,
                           const Eigen::Vector3d& p1);
FlatParts parts_over_flats(const ConeShape& cone, const Eigen::Vector3d& p0,
                           const Eigen::Vector3d& p1);
FlatParts parts_over_flats(const CapsuleShape& capsule, const Eigen::Vector3d& p0,
                           const Eigen::Vector3d& p1);
FlatParts parts_over_flats(const TriangleCorners& triangle, const Eigen::Vector3d& p0,
                           const Eigen::Vector3d& p1);

/// Those of a sphere and of planes, which have no end.
template <class Solid>
FlatParts parts_over_flats(const Solid& /*solid*/, const Eigen::Vector3d& /*p0*/,
                           const Eigen::Vector3d& /*p1*/) {
  return {};
}

}  // namespace fiber
