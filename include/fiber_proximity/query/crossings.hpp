#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

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
  /// @throws std::invalid_argument for more than max_threads
  explicit CrossingFinder(std::uint32_t threads = 0);

  /// @param crossings overwritten; sorted by SegmentIdPair::key()
  /// @throws std::invalid_argument for a view that does not validate
  void find(const FiberAssembly& fibers, const View& view, std::vector<Crossing>& crossings);

 private:
  std::unique_ptr<ProximityEngine> engine_;
  FiberAssembly image_;
  QueryResult candidates_;
};

/// Finds crossings once, as CrossingFinder::find().
std::vector<Crossing> find_crossings(const FiberAssembly& fibers, const View& view);

/// How often one closed fibre is wound around another.
struct LinkingNumber {
  std::uint32_t fiber_a = 0;
  std::uint32_t fiber_b = 0;  ///< larger
  std::int64_t value = 0;     ///< not 0
};

/// The Gauss linking numbers of all pairs of fibres whose number is not 0, sorted by fibre. The
/// last point of each fibre is joined to its first.
///
/// The sum of the signs of the crossings in which a is above b, seen from any side: an integer
/// without error, as the crossings are (see CrossingFinder). Curves that touch have no linking
/// number; theirs is that of curves moved apart by infinitesimal amounts.
std::vector<LinkingNumber> linking_numbers(const FiberAssembly& fibers);

/// The linking number of two closed polygons; the last point is joined to the first [m].
/// @throws std::invalid_argument for fewer than two points, or a bad coordinate
std::int64_t linking_number(const std::vector<Eigen::Vector3d>& curve_a,
                            const std::vector<Eigen::Vector3d>& curve_b);

/// Whether a curve's last point is joined to its first.
enum class CurveEnds { OPEN, CLOSED };

/// The writhe of a polygon: the mean, over all directions of view, of the sum of the signs of its
/// crossings with itself; twice the sum of the Gauss integrals of its pairs of segments (Klenin and
/// Langowski 2000, eq. 13). 0 for curves in a plane and those that are their own mirror image.
/// O(n²); the same for any number of threads.
/// @param points [m] of a magnitude up to FiberAssembly::max_coordinate
double writhe(const std::vector<Eigen::Vector3d>& points, CurveEnds ends = CurveEnds::OPEN);

}  // namespace fiber
