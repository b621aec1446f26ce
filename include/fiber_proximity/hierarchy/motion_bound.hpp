#pragma once

#include <Eigen/Core>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Remembers where fibres were, to tell how far they have moved since.
class MotionBound {
 public:
  /// From now on, motion is measured from here.
  void start(const FiberAssembly& fibers);

  /// The largest distance of a point from where it was, rounded up [m]; a segment's points move no
  /// further than its ends. Infinite if radii have changed. The topology must be that of start().
  double largest_motion(const FiberAssembly& fibers) const;

  std::size_t memory_bytes() const;

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> radii_;
};

}  // namespace fiber
