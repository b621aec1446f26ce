#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Coherent motion: fibres sway as in a slow current. Every point goes round a circle, all at the
/// same speed, and what is near in space is near in phase, so a scene keeps its shape for ever.
/// Each fibre is a little ahead of its neighbours or behind them, so pairs come and go.
class Swaying {
 public:
  /// @param step [m] how far every point moves from one frame to the next, >= 0
  /// @param seed of the directions, planes and phases
  /// @param moving the part of the fibres that move, evenly spread, in [0, 1]; others stand still
  Swaying(const FiberAssembly& fibers, double step, std::uint64_t seed, double moving = 1.0);

  /// The points in a frame; they stay until the next call.
  const std::vector<Eigen::Vector3d>& points(std::uint32_t frame);

 private:
  std::vector<Eigen::Vector3d> centers_;
  std::vector<double> phases_;  // [turns]
  std::vector<double> speeds_;  // by point, 1 or 0
  std::vector<Eigen::Vector3d> points_;
  Eigen::Vector3d first_axis_;  // [m] these two span the circles
  Eigen::Vector3d second_axis_;
};

/// @returns [m] 0 without segments
double mean_segment_length(const FiberAssembly& fibers);

}  // namespace fiber
