#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <string>
#include <variant>
#include <vector>

namespace fiber {

class TriangleMesh;
class OccupancyOctree;

/// Solids of the environment, each in its own frame, as shape_msgs/SolidPrimitive has them: centred
/// at the origin, along z. All lengths in metres, finite and at least 0.
struct BoxShape {
  Eigen::Vector3d size = Eigen::Vector3d::Zero();  ///< edge to edge
  bool operator==(const BoxShape& other) const { return size == other.size; }
};

/// Around the origin.
struct SphereShape {
  double radius = 0.0;
  bool operator==(const SphereShape& other) const { return radius == other.radius; }
};

/// From z = −height/2 to height/2.
struct CylinderShape {
  double radius = 0.0;
  double height = 0.0;
  bool operator==(const CylinderShape& other) const {
    return radius == other.radius && height == other.height;
  }
};

/// Its base at z = −height/2, its apex at z = height/2.
struct ConeShape {
  double radius = 0.0;
  double height = 0.0;
  bool operator==(const ConeShape& other) const {
    return radius == other.radius && height == other.height;
  }
};

/// Around a segment along z of this length, so that it is 2 radius + length high.
struct CapsuleShape {
  double radius = 0.0;
  double length = 0.0;
  bool operator==(const CapsuleShape& other) const {
    return radius == other.radius && length == other.length;
  }
};

/// All points p with normal·p <= offset are solid.
struct HalfSpaceShape {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of unit length, out of the solid
  double offset = 0.0;
  bool operator==(const HalfSpaceShape& other) const {
    return normal == other.normal && offset == other.offset;
  }
};

/// All points p with normal·p = offset: a sheet that can be touched from both sides.
struct PlaneShape {
  Eigen::Vector3d normal = Eigen::Vector3d::UnitZ();  ///< of unit length
  double offset = 0.0;
  bool operator==(const PlaneShape& other) const {
    return normal == other.normal && offset == other.offset;
  }
};

/// Shapes that are made once and shared are behind a pointer, which is never null.
using Shape = std::variant<BoxShape, SphereShape, CylinderShape, ConeShape, CapsuleShape,
                           HalfSpaceShape, PlaneShape, std::shared_ptr<const TriangleMesh>,
                           std::shared_ptr<const OccupancyOctree>>;

/// A shape somewhere.
struct PlacedShape {
  Shape shape;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the shape in its object's frame
};

/// A body of one or more shapes, such as a link of a robot.
struct EnvironmentObject {
  std::string name;
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();  ///< of the object in the world
  std::vector<PlacedShape> shapes;
};

/// Whether one could be the other, moved; meshes and octrees must be the same objects in memory.
bool have_same_shapes(const EnvironmentObject& x, const EnvironmentObject& y);

/// @throws std::invalid_argument naming what is wrong with the shape, the value and what is allowed
void validate(const Shape& shape);

/// A pose must be a rotation and a finite translation.
/// @throws std::invalid_argument otherwise
void validate(const Eigen::Isometry3d& pose);

/// Validates an object, all its shapes and its name, which must not be empty.
/// @throws std::invalid_argument naming the object and the shape, too
void validate(const EnvironmentObject& object);

/// Axis-aligned box in double precision [m].
using WorldBox = Eigen::AlignedBox3d;

/// Smallest box around a solid with this pose, rounded outwards; around a mesh or octree one that
/// need not be the smallest. Infinite along all axes for planes and half-spaces.
WorldBox world_box(const Shape& shape, const Eigen::Isometry3d& pose);

/// Whether the shape ends somewhere: planes and half-spaces do not.
bool is_bounded(const Shape& shape);

/// Where the axis of a fibre's segment is nearest to a shape, or deepest in it, in the shape's
/// frame.
struct AxisDistance {
  double s = 0.0;         ///< parameter on the segment, 0 at its first point and 1 at its second
  double distance = 0.0;  ///< [m] signed distance of that point, negative inside
  double lower = 0.0;     ///< [m] no point of the segment has a smaller one, rounding apart
  Eigen::Vector3d gradient = Eigen::Vector3d::UnitX();  ///< away from the shape, of unit length
};

/// Least signed distance of the points of a segment [m] from a shape. Of meshes and octrees nothing
/// further away than the bound [m] is looked for: their distance is infinite then.
AxisDistance axis_distance(const Shape& shape, const Eigen::Vector3d& p0, const Eigen::Vector3d& p1,
                           double bound);

/// Largest distance of a shape's points from its frame's origin [m], 0 of an unbounded one; what
/// rounding errors are measured in.
double reach(const Shape& shape);

}  // namespace fiber
