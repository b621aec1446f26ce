#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace rviz {
class ViewController;
}  // namespace rviz

namespace fiber_proximity_rviz {

/// Moves rviz's view to where fibres are: once, and again when there are more of them, as long as
/// nobody has moved it since.
class ViewFitter {
 public:
  /// The next fibres are the first ones again.
  void forget();

  /// Shows fibres, if that is due. rviz's orbit view is fitted to them. In an optical frame (by its
  /// name; z forwards, y downwards: REP 103) it looks from above the camera forwards, in any other
  /// from where it looks already. Other kinds of views look at their middle.
  /// @param frame the fixed frame
  /// @param pose  of the fibres' frame in it
  void fit(rviz::ViewController& view, const std::string& frame, const fiber::FiberAssembly& fibers,
           const Eigen::Isometry3d& pose);

 private:
  std::size_t fiber_count_ = 0;  // of those last fitted to
  std::vector<float> as_left_;   // the view's numbers after that
};

}  // namespace fiber_proximity_rviz
