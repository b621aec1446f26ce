#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fiber {

/// A smooth field of displacements that follows how points move: trilinear in the cells of a grid
/// around them, fitted to a sample. What is near each other moves alike: a head of hair turns, a
/// bundle is carried, waves run through cloth.
class MotionField {
 public:
  /// Makes room for so many points, which nobody touches before start().
  void reserve(std::size_t points);

  /// The field is 0. No topology has more points than there is room for.
  /// @param points where displacements are measured from
  /// @param lower, upper [m] of a box around them
  void start(const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& lower,
             const Eigen::Vector3d& upper);

  /// [m] The largest displacement in the sample.
  double sampled_motion(const std::vector<Eigen::Vector3d>& before,
                        const std::vector<Eigen::Vector3d>& now) const;

  /// Follows the sample to where it is now.
  /// @param before the points of start()
  /// @return [m] the farthest of the sample from the field
  double follow(const std::vector<Eigen::Vector3d>& before,
                const std::vector<Eigen::Vector3d>& now);

  /// [m] The displacement of what was here, in the box of start().
  Eigen::Vector3d at(const Eigen::Vector3d& point) const {
    Eigen::Vector3d part;
    return value(cell_of(point, part), part);
  }

  /// A Lipschitz constant of the field, rounded up.
  double rate() const { return rate_; }

  /// [m] In the mean over the grid; by how much the field differs from it at most; how far at()
  /// may be from the field by rounding.
  const Eigen::Vector3d& drift() const { return drift_; }
  double beyond_drift() const { return beyond_drift_; }
  double rounding() const { return rounding_; }

  std::size_t memory_bytes() const;

 private:
  static constexpr std::uint32_t max_cells = 8;  // along an axis

  /// The terms of a cell by powers of the place in it: bit a of their index is that of axis a.
  using Terms = std::array<Eigen::Vector3d, 8>;

  /// @param part where the point is in the cell, from 0 to 1 by axis
  std::size_t cell_of(const Eigen::Vector3d& point, Eigen::Vector3d& part) const {
    std::size_t cell = 0;
    for (int axis = 2; axis >= 0; --axis) {
      const double place = (point[axis] - lower_[axis]) * cells_per_meter_;
      // Points outside of the box are of no segment.
      const double inside = std::clamp(place, 0.0, static_cast<double>(cells_[axis] - 1));
      const auto index = static_cast<double>(static_cast<int>(inside));
      part[axis] = place - index;
      cell = cell * cells_[axis] + static_cast<std::size_t>(index);
    }
    return cell;
  }

  Eigen::Vector3d value(std::size_t cell, const Eigen::Vector3d& part) const {
    const Terms& c = terms_[cell];
    const double x = part.x();
    const double y = part.y();
    return ((c[7] * x + c[6]) * y + (c[5] * x + c[4])) * part.z() +
           ((c[3] * x + c[2]) * y + (c[1] * x + c[0]));
  }

  void find_corners();
  Terms corners_of(std::size_t cell) const;
  void correct(const std::vector<Eigen::Vector3d>& before, const std::vector<Eigen::Vector3d>& now);
  void fill();
  Eigen::Vector3d mean_around(std::size_t here) const;
  void find_terms();
  void find_bounds();

  Eigen::Vector3d lower_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d upper_ = Eigen::Vector3d::Zero();
  double cells_per_meter_ = 1.0;
  std::array<std::size_t, 3> cells_{1, 1, 1};
  std::array<std::size_t, 8> corner_nodes_{};
  std::vector<std::size_t> first_nodes_;  // by cell
  std::size_t stride_ = 1;                // of the sample
  std::vector<Eigen::Vector3d> nodes_;
  std::vector<double> weights_;          // of the sample, by node
  std::vector<Eigen::Vector3d> sums_;    // of what the sample is off, by node
  std::vector<std::uint8_t> are_known_;  // nodes
  std::vector<Terms> terms_;             // by cell
  double rate_ = 0.0;
  Eigen::Vector3d drift_ = Eigen::Vector3d::Zero();
  double beyond_drift_ = 0.0;
  double rounding_ = 0.0;
};

}  // namespace fiber
