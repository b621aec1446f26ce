#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/environment/triangle_mesh.hpp"

namespace fiber_proximity_ros {

/// Reads meshes (fiber::read_mesh_file) only from where they may lie: in ROS packages,
/// package://NAME/PATH, and in the folders that are configured, file:///PATH. Symbolic links do not
/// lead out of these. A fiber::MeshSource.
class MeshLoader {
 public:
  MeshLoader() = default;

  /// @throws std::invalid_argument for a folder that is not there
  explicit MeshLoader(const std::vector<std::string>& folders);

  /// @throws std::invalid_argument naming the resource and what is wrong: where it lies, its size,
  ///         its content, or the scale
  std::shared_ptr<const fiber::TriangleMesh> operator()(const std::string& resource,
                                                        const Eigen::Vector3d& scale) const;

 private:
  std::filesystem::path resolve(const std::string& resource) const;

  std::vector<std::filesystem::path> folders_;
};

}  // namespace fiber_proximity_ros
