#pragma once

#include <Eigen/Core>
#include <string>
#include <vector>

#include "fiber_proximity/environment/triangle_mesh.hpp"

namespace fiber {

/// What a file of a mesh holds.
struct ParsedMesh {
  std::vector<Eigen::Vector3d> vertices;  ///< [m]
  std::vector<TriangleMesh::Triangle> triangles;
};

/// Lets assimp take a file's bytes apart, in a process of its own that ends with it: there are
/// files it crashes on, does not come back from, or takes all memory for, and these are to cost
/// only themselves.
/// @param name of the file, which tells the format
/// @throws std::invalid_argument if there is no mesh in it or too large a one, or assimp fails
ParsedMesh parse_mesh(const std::string& bytes, const std::string& name);

}  // namespace fiber
