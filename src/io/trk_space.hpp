#pragma once

#include <Eigen/Geometry>
#include <string>
#include <string_view>

namespace fiber {

/// The header of a .trk file, as far as it says where points are.
struct TrkSpace {
  Eigen::Vector3d dimensions;    // of the volume [voxel]
  Eigen::Vector3d voxel_size;    // [mm]
  Eigen::Matrix4d vox_to_ras;    // from voxels, counted from the middle of the first one [mm]
  std::string_view voxel_order;  // where the axes of voxels point to: L or R, A or P, I or S each

  /// Whether the matrix is there; files of the first version have none.
  bool has_matrix() const { return vox_to_ras(3, 3) != 0.0; }
};

/// From the points of a file, which count from the corner of the first voxel [mm], to the space of
/// vox_to_ras [mm].
/// @param space has a matrix
/// @throws std::invalid_argument for a voxel order that is none
Eigen::Affine3d ras_of_points(const TrkSpace& space);

}  // namespace fiber
