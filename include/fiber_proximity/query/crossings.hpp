#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// How fibres are looked at.
struct View {
  /// Along which the viewer looks, of any length but 0: from above by default. What is further
  /// along it is further away.
  Eigen::Vector3d direction = -Eigen::Vector3d::UnitZ();

  /// Whether the rays of sight start in the eye, as a camera's; else all are parallel to the
  /// direction.
  bool is_perspective = false;

  /// [m] Only what is in front of it, further along the direction, is seen.
  Eigen::Vector3d eye = Eigen::Vector3d::Zero();
};

/// @throws std::invalid_argument naming what is wrong, its value and what is allowed
void validate(const View& view);

/// Where the axes of two segments, the smaller one first, cross as a viewer sees them: on one ray
/// of sight.
struct Crossing : SegmentIdPair {
  double s = 0.0;  ///< curve parameter on segment a, in [0, 1]; within 2⁻³⁸ of the exact one
  double t = 0.0;  ///< the same on segment b

  bool a_is_over = false;  ///< a is nearer to the viewer; exact, as is the sign
  /// As in knot theory: +1 where the strand above turns counter-clockwise, by less than half a
  /// turn, to the direction of the one below, as the viewer sees them; else −1. The same from both
  /// sides, and for both directions of both strands together.
  int sign = 0;

  double separation = 0.0;  ///< of the two axes along the ray of sight, >= 0 [m]
  /// The separation less both radii [m]: what is left between fibres that lie across the ray,
  /// negative where they cannot pass. The signed distance of the two segments is at most this.
  double gap = 0.0;
  Eigen::Vector3d point_a;  ///< on the axis of a [m]
  Eigen::Vector3d point_b;  ///< on the axis of b [m]
};

/// Finds where fibres cross over and under each other and themselves in a view; keeps its memory
/// from call to call.
///
/// Which segments cross, which one is above, and the sign are decided without rounding, as for
/// fibres whose points have been moved by infinitesimal amounts, all different (simulation of
/// simplicity, see perturbed_orientation.hpp). So
///  - a crossing that is seen exactly at a vertex counts once, for one of the two segments that
///    share it; where a fibre only touches another's image there it counts twice, with opposite
///    signs, or not at all;
///  - segments seen edge-on, one behind the other, cross where the moved ones do, at an end of one
///    of them;
///  - of axes that touch, one is above by the perturbation alone; the separation is 0.
/// Points of a fibre that follow each other and are the same move together, and so do its first and
/// last point if they are the same: a segment of no length crosses nothing, and segments that share
/// a point by this are neighbours, no pair.
class CrossingFinder {
 public:
  /// @param threads most to use, 0 for as many as there are cores
  /// @throws std::invalid_argument for more than most_threads
  explicit CrossingFinder(std::uint32_t threads = 0);

  /// @param crossings overwritten; sorted by SegmentIdPair::key()
  /// @throws std::invalid_argument for a view that does not validate
  void find(const FiberAssembly& fibers, const View& view, std::vector<Crossing>& crossings);

 private:
  std::unique_ptr<ProximityEngine> engine_;
  FiberAssembly image_;
  QueryResult candidates_;
};

/// The same, once.
std::vector<Crossing> find_crossings(const FiberAssembly& fibers, const View& view);

}  // namespace fiber
