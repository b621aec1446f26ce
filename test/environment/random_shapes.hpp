#pragma once

#include <Eigen/Geometry>
#include <array>
#include <memory>
#include <vector>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

inline Eigen::Isometry3d random_pose(Random& random, double extent) {
  Eigen::Isometry3d pose(Eigen::AngleAxisd(random.uniform(-4.0, 4.0), random.direction()));
  pose.translation() = random.in_cube(extent);
  return pose;
}

/// A grid of triangles over each face of a box of this size, counter-clockwise from outside, each
/// with three vertices of its own, as STL files have them.
inline std::shared_ptr<const TriangleMesh> box_mesh(const Eigen::Vector3d& size, int cells) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
  const auto add = [&](const std::array<Eigen::Vector3d, 3>& corners) {
    const auto first = static_cast<std::uint32_t>(vertices.size());
    for (const Eigen::Vector3d& corner : corners) {
      vertices.push_back(corner.cwiseProduct(size / 2.0));
    }
    triangles.push_back({first, first + 1, first + 2});
  };
  for (int axis = 0; axis < 3; ++axis) {
    for (const double side : {-1.0, 1.0}) {
      const auto at = [&](int i, int j) {
        Eigen::Vector3d point;
        point[axis] = side;
        point[(axis + 1) % 3] = side * (2 * i - cells) / cells;  // turned about on the other side
        point[(axis + 2) % 3] = static_cast<double>(2 * j - cells) / cells;
        return point;
      };
      for (int i = 0; i < cells; ++i) {
        for (int j = 0; j < cells; ++j) {
          add({at(i, j), at(i + 1, j), at(i + 1, j + 1)});
          add({at(i, j), at(i + 1, j + 1), at(i, j + 1)});
        }
      }
    }
  }
  return std::make_shared<const TriangleMesh>(vertices, triangles);
}

/// Triangles anywhere, which is no closed mesh.
inline std::shared_ptr<const TriangleMesh> triangle_soup(Random& random, std::uint32_t count,
                                                         double extent) {
  std::vector<Eigen::Vector3d> vertices;
  std::vector<TriangleMesh::Triangle> triangles;
  for (std::uint32_t i = 0; i < count; ++i) {
    const Eigen::Vector3d centre = random.in_cube(extent);
    for (int corner = 0; corner < 3; ++corner) {
      vertices.emplace_back(centre + random.in_cube(0.2 * extent));
    }
    triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2});
  }
  return std::make_shared<const TriangleMesh>(vertices, triangles);
}

/// The cells that hold one of the points [m] at least.
inline std::shared_ptr<const OccupancyOctree> octree_of(
    double resolution, const std::vector<Eigen::Vector3d>& points) {
  std::vector<OccupancyOctree::Cell> cells;
  for (const Eigen::Vector3d& point : points) {
    cells.push_back(OccupancyOctree::cell_at(resolution, point).value());
  }
  return std::make_shared<const OccupancyOctree>(resolution, cells);
}

inline std::shared_ptr<const OccupancyOctree> random_octree(Random& random, int points,
                                                            double extent) {
  std::vector<Eigen::Vector3d> cloud;
  for (int i = 0; i < points; ++i) {
    cloud.push_back(random.in_cube(extent));
  }
  return octree_of(0.1 * extent, cloud);
}

/// One of each kind, of about this extent [m].
inline std::vector<Shape> random_shapes(Random& random, double extent) {
  const auto length = [&] { return extent * random.uniform(0.1, 1.0); };
  const Eigen::Vector3d size(length(), length(), length());
  return {BoxShape{size},
          SphereShape{length()},
          CylinderShape{length(), length()},
          ConeShape{length(), length()},
          CapsuleShape{length(), length()},
          HalfSpaceShape{random.direction(), length()},
          PlaneShape{random.direction(), length()},
          box_mesh(size, 3),
          triangle_soup(random, 30, extent),
          random_octree(random, 40, extent)};
}

}  // namespace fiber::test
