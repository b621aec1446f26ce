#include "src/io/trk_space.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

/// An axis of voxels along an axis of the space.
struct Direction {
  int axis = 0;  // from left to right, from posterior to anterior, or from inferior to superior
  bool is_reversed = false;
};

/// @throws std::invalid_argument
void read_order(std::string_view order, Direction (&directions)[3]) {
  constexpr std::string_view forward = "RAS";
  constexpr std::string_view backward = "LPI";
  bool seen[3] = {};
  for (std::size_t i = 0; i < 3; ++i) {
    const char letter = i < order.size() ? order[i] : '\0';
    const std::size_t ahead = forward.find(letter);
    const std::size_t back = backward.find(letter);
    const std::size_t axis = ahead != std::string_view::npos ? ahead : back;
    if (axis == std::string_view::npos || order.size() != 3 || std::exchange(seen[axis], true)) {
      throw std::invalid_argument("the voxel_order (byte 948) is " + quote(order) +
                                  ", expected one of L and R, of A and P, and of I and S");
    }
    directions[i] = {static_cast<int>(axis), ahead == std::string_view::npos};
  }
}

/// The axes of the space that those of voxels are nearest to, the first one first, as nibabel
/// chooses them.
void nearest_axes(const Eigen::Matrix3d& matrix, Direction (&directions)[3]) {
  Eigen::Matrix3d left = matrix.colwise().normalized().cwiseAbs();
  for (int column = 0; column < 3; ++column) {
    int axis = 0;
    left.col(column).maxCoeff(&axis);
    directions[column] = {axis, matrix(axis, column) < 0.0};
    left.row(axis).setConstant(-1.0);
  }
}

}  // namespace

Eigen::Affine3d ras_of_points(const TrkSpace& space) {
  Direction of_file[3];
  Direction of_matrix[3];
  // TrackVis takes LPS where nothing is told.
  read_order(space.voxel_order.empty() ? "LPS" : space.voxel_order, of_file);
  const Eigen::Matrix3d matrix = space.vox_to_ras.topLeftCorner<3, 3>();
  nearest_axes(matrix, of_matrix);
  Eigen::Affine3d voxels = Eigen::Affine3d::Identity();  // of the matrix, from points of the file
  for (int row = 0; row < 3; ++row) {
    int column = 0;
    while (of_file[column].axis != of_matrix[row].axis) {
      ++column;
    }
    const double sign = of_file[column].is_reversed == of_matrix[row].is_reversed ? 1.0 : -1.0;
    voxels.linear().row(row).setZero();
    voxels.linear()(row, column) = sign / space.voxel_size[column];
    voxels.translation()[row] = sign > 0.0 ? -0.5 : space.dimensions[column] - 0.5;
  }
  Eigen::Affine3d ras;
  ras.matrix() = space.vox_to_ras;
  return ras * voxels;
}

}  // namespace fiber
