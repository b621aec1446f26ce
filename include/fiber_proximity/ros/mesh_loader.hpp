#pragma once

#include <shape_msgs/Mesh.h>

#include <Eigen/Core>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace fiber_proximity_ros {

/// Reads meshes from files, in any format that assimp knows, and only from where they may lie: in
/// ROS packages, package://NAME/PATH, and in the folders that are configured, file:///PATH.
/// Symbolic links do not lead out of these. Files that assimp crashes on or hangs with are refused.
class MeshLoader {
 public:
  /// [byte] Larger files are refused unread: twice a binary STL of as many triangles as
  /// fiber::TriangleMesh takes.
  static constexpr std::uintmax_t largest_file = 100'000'000;

  MeshLoader() = default;

  /// @throws std::invalid_argument for a folder that is not there
  explicit MeshLoader(const std::vector<std::string>& folders);

  /// @param scale of each axis; a mirrored mesh has its triangles turned round, so that they are
  ///        still counter-clockwise from outside
  /// @throws std::invalid_argument naming the resource and what is wrong: where it lies, its size,
  ///         its content, or the scale
  shape_msgs::Mesh load(const std::string& resource, const Eigen::Vector3d& scale) const;

 private:
  std::filesystem::path resolve(const std::string& resource) const;

  std::vector<std::filesystem::path> folders_;
};

}  // namespace fiber_proximity_ros
