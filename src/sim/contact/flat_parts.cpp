#include "src/sim/contact/flat_parts.hpp"

#include <Eigen/Geometry>
#include <cmath>

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Keeps what of a part is within half of an extent on both sides of 0.
void keep_within(EdgePart& part, double half, double at_first_node, double at_last_node) {
  part.keep_positive(half - at_first_node, half - at_last_node);
  part.keep_positive(half + at_first_node, half + at_last_node);
}

/// The part within a radius of the z axis.
EdgePart part_in_circle(double radius, const Vector3d& p0, const Vector3d& p1) {
  const Eigen::Vector2d start = p0.head<2>();
  const Eigen::Vector2d way = p1.head<2>() - start;
  const double square = way.squaredNorm();
  if (square == 0.0) {
    return {1.0, 0.0};
  }
  const double middle = -start.dot(way) / square;
  const double half_square = (radius * radius - (start + middle * way).squaredNorm()) / square;
  if (half_square < 0.0) {
    return {1.0, 0.0};
  }
  const double half = std::sqrt(half_square);
  return {middle - half, middle + half};
}

/// The part that is nearest to a straight line between its ends.
EdgePart part_along(const Vector3d& from, const Vector3d& to, const Vector3d& p0,
                    const Vector3d& p1) {
  const Vector3d way = to - from;
  EdgePart part;
  part.keep_positive(way.dot(p0 - from), way.dot(p1 - from));
  part.keep_positive(way.dot(to - p0), way.dot(to - p1));
  return part;
}

EdgePart part_along_axis(double half, const Vector3d& p0, const Vector3d& p1) {
  return part_along(-half * Vector3d::UnitZ(), half * Vector3d::UnitZ(), p0, p1);
}

}  // namespace

FlatParts parts_over_flats(const BoxShape& box, const Vector3d& p0, const Vector3d& p1) {
  FlatParts found;
  for (Eigen::Index face = 0; face < 3; ++face) {
    EdgePart part;
    for (Eigen::Index i = 0; i < 3; ++i) {
      if (i != face) {
        keep_within(part, 0.5 * box.size[i], p0[i], p1[i]);
      }
    }
    found.add(part);
  }
  for (Eigen::Index i = 0; i < 3; ++i) {
    EdgePart part;
    keep_within(part, 0.5 * box.size[i], p0[i], p1[i]);
    found.add(part);
  }
  return found;
}

FlatParts parts_over_flats(const CylinderShape& cylinder, const Vector3d& p0, const Vector3d& p1) {
  FlatParts found;
  found.add(part_in_circle(cylinder.radius, p0, p1));
  found.add(part_along_axis(0.5 * cylinder.height, p0, p1));
  return found;
}

FlatParts parts_over_flats(const ConeShape& cone, const Vector3d& p0, const Vector3d& p1) {
  FlatParts found;
  found.add(part_in_circle(cone.radius, p0, p1));
  // The line of its side that goes up inwards as the edge does.
  Vector3d outwards = p1.z() > p0.z() ? Vector3d(p0 - p1) : Vector3d(p1 - p0);
  outwards.z() = 0.0;
  const Vector3d apex = 0.5 * cone.height * Vector3d::UnitZ();
  found.add(part_along(cone.radius * outwards.stableNormalized() - apex, apex, p0, p1));
  return found;
}

FlatParts parts_over_flats(const CapsuleShape& capsule, const Vector3d& p0, const Vector3d& p1) {
  FlatParts found;
  found.add(part_along_axis(0.5 * capsule.length, p0, p1));
  return found;
}

FlatParts parts_over_flats(const TriangleCorners& triangle, const Vector3d& p0,
                           const Vector3d& p1) {
  const Vector3d normal = (triangle[1] - triangle[0]).cross(triangle[2] - triangle[0]);
  FlatParts found;
  EdgePart over_face;
  std::array<EdgePart, 3> along;
  for (std::size_t i = 0; i < 3; ++i) {
    const Vector3d& from = triangle[i];
    const Vector3d& to = triangle[(i + 1) % 3];
    const Vector3d inwards = normal.cross(to - from);
    over_face.keep_positive(inwards.dot(p0 - from), inwards.dot(p1 - from));
    along[i] = part_along(from, to, p0, p1);
  }
  found.add(over_face);
  for (const EdgePart& part : along) {
    found.add(part);
  }
  return found;
}

}  // namespace fiber
