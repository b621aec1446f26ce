#pragma once

#include <Eigen/Geometry>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"

namespace fiber {

/// A tangent plane of an object, at the point nearest to a place on a rod.
struct TangentPlane {
  double s;                ///< of that place: parameter on the segment asked about
  double distance;         ///< from it [m]
  Eigen::Vector3d point;   ///< of the object [m]
  Eigen::Vector3d normal;  ///< unit vector from the object to the place

  /// How far the ends of the segment are from the part of the object that the plane is of [m].
  double end_distances[2];
};

/// Whether a shape is convex, so that all of it is behind each of its tangent planes.
bool is_convex(const Shape& shape);

/// The tangent planes of a mesh or an octree at the points of its triangles or cells that are
/// nearest to a segment, of those within a distance [m]; without those whose point is not in front
/// of a nearer one's plane, as of triangles beside each other in one plane, or around an edge that
/// points outwards.
/// @param pose of the shape in the world
std::vector<TangentPlane> tangent_planes(const Shape& shape, const Eigen::Isometry3d& pose,
                                         const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                                         double within);

}  // namespace fiber
