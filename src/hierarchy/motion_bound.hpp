#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Remembers where fibres were, to tell how far each has moved since.
class MotionBound {
 public:
  /// Makes room for so many, which nobody touches before start().
  void reserve(std::size_t points, std::size_t fibers);

  /// From now on, motion is measured from here.
  void start(const FiberAssembly& fibers);

  /// Measures one fibre from here from now on, of the topology and radii of start().
  void restart(const FiberAssembly& fibers, std::uint32_t fiber);

  /// Measures how far every fibre has moved. The topology must be that of start().
  /// @return [m] the largest distance of a point from where it was, rounded up; a segment's points
  /// move no further than its ends. Infinite if radii have changed.
  double measure(const FiberAssembly& fibers);

  /// [m] How far each fibre has moved, as measured last; not set if radii have changed.
  const std::vector<double>& by_fiber() const { return by_fiber_; }

  std::size_t memory_bytes() const;

 private:
  double motion_of(const FiberAssembly& fibers, std::uint32_t fiber) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> radii_;
  std::vector<double> by_fiber_;
};

}  // namespace fiber
