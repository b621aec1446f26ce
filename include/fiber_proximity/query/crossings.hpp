#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/crossing.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/view.hpp"

namespace fiber {

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

  /// @param crossings overwritten; sorted by Crossing::key()
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
