#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "src/environment/triangle_distance.hpp"

namespace fiber {

/// How the triangles of a mesh hang together, and which side of them is inside.
class MeshTopology {
 public:
  MeshTopology(const std::vector<Eigen::Vector3d>& vertices,
               const std::vector<TriangleMesh::Triangle>& triangles);

  bool is_closed() const { return is_closed_; }

  /// Out of the solid at this feature of a triangle; of no particular length. A point whose nearest
  /// point is there is outside if it lies along it: the angle-weighted pseudonormal of J. A.
  /// Baerentzen and H. Aanaes 2005, "Signed distance computation using the angle weighted
  /// pseudonormal".
  Eigen::Vector3d normal(std::uint32_t triangle, const TriangleFeature& feature) const;

 private:
  void join_triangles();

  struct Normals {
    Eigen::Vector3d face = Eigen::Vector3d::Zero();
    std::array<Eigen::Vector3d, 3> edges;
  };

  std::vector<TriangleMesh::Triangle> welded_;   // by triangle: vertices, one for each place
  std::vector<Normals> normals_;                 // by triangle
  std::vector<Eigen::Vector3d> corner_normals_;  // by welded vertex
  bool is_closed_ = true;
  double outwards_ = 1.0;  // −1 where the triangles are clockwise
};

}  // namespace fiber
