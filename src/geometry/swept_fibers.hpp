#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// @throws std::invalid_argument if there is no motion from one to the other, as the numbers of
///         their fibres and of the points of these are not the same
FIBER_PROXIMITY_EXPORT void require_same_topology(const FiberAssembly& before,
                                                  const FiberAssembly& after);

/// [m] What fibres of one topology have in common of their ways: about the mean of some points,
/// evenly spread.
Eigen::Vector3d drift_of(const FiberAssembly& before, const FiberAssembly& after);

/// Fibres that hold all that others come by while each of their points moves linearly: each segment
/// where it is halfway, thicker by half the way of its ends.
///
/// The drift, common to all points, is taken out of the ways: it brings no two segments
/// nearer. Between two segments the true gap at any time is at least that of the swept ones.
class SweptFibers {
 public:
  /// @throws std::invalid_argument if the two are not of one topology, or naming the fibre and
  ///         segment that moves so far that it would be thicker than FiberAssembly::max_coordinate;
  ///         what there was is lost then
  void update(const FiberAssembly& before, const FiberAssembly& after);

  /// Sweeps a shape that is compared with fibres of this drift [m].
  void update(const FiberAssembly& before, const FiberAssembly& after,
              const Eigen::Vector3d& drift);

  const FiberAssembly& fibers() const { return fibers_; }
  const Eigen::Vector3d& drift() const { return drift_; }

 private:
  Eigen::Vector3d drift_ = Eigen::Vector3d::Zero();  // [m]
  FiberAssembly fibers_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> half_ways_;      // [m] by point
  std::vector<double> segment_radii_;  // [m] by first point
};

}  // namespace fiber
