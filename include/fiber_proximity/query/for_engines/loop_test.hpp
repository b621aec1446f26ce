#pragma once

#include <cstddef>
#include <cstdint>
#include <mutex>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

class FiberGraph;
class LoopReach;

/// Tells contacts of a fibre with itself from segments that are near because they follow each
/// other: self-contact needs a loop.
///
/// Two places of a fibre are joined by a loop if a point between them is further away from one of
/// the two than 5/4 of their distance plus 5/2 radii. Places of touching strands, two radii apart,
/// therefore need a point between them that is five radii away. Of two segments, the places where
/// they are nearest count, and the outer end of each with the place nearest to it, if these are at
/// most one radius further apart: parallel strands are nearest at more than one place. The radius
/// is that of the thicker segment.
///
/// Where fibres are closed or joined, every way along the graph from one segment to the other is
/// asked, those to other fibres as well: only if each of them makes a loop, the segments do. A way
/// runs through neither of the two, and their outer ends are those that it does not come by.
///
/// The rule knows no margin, so a larger margin never hides a contact. No stretch of a fibre has
/// contacts with itself that turns by less than a right angle, even if every point is off by up to
/// half a radius (LoopFreeStretches proves it).
///
/// Refers to the fibres: they must outlive it, unchanged. Several threads may ask.
class LoopTest {
 public:
  LoopTest();  ///< of no fibres
  explicit LoopTest(const FiberAssembly& fibers);
  ~LoopTest();
  LoopTest(const LoopTest&) = delete;
  LoopTest& operator=(const LoopTest&) = delete;

  /// From now on asks about these fibres, or about where they are now, in the memory it has.
  void reset(const FiberAssembly& fibers);

  /// Memory of what is known of fibres [bytes].
  std::size_t memory_bytes() const;

  /// Whether both are segments of one fibre.
  bool are_of_one_fiber(PointPair pair) const {
    return pair.b - pair.a < max_points_ && is_within(fibers_->segment_id(pair.a).fiber, pair.b);
  }

  /// Whether a way leads from one segment to the other: both are of one fibre, or of fibres that
  /// are joined.
  bool are_joined(PointPair pair) const {
    return graph_ == nullptr ? are_of_one_fiber(pair) : are_joined_by_graph(pair);
  }

  /// Whether a loop is between two segments that are joined and share no point: whether all ways
  /// from one to the other make one.
  /// @param pair the smaller index first
  /// @param nearest of the kernel robust
  /// @param loop_steps grows by the points and boxes of the fibre that had to be visited
  bool makes_loop(PointPair pair, const SegmentDistance& nearest, std::uint64_t& loop_steps) const;
  bool makes_loop(PointPair pair, const SegmentDistance& nearest) const {
    std::uint64_t loop_steps = 0;
    return makes_loop(pair, nearest, loop_steps);
  }

  /// Whether it is certain that no two segments make a loop that start at the points first … last;
  /// false if these are not of one fibre. Costs little, once a fibre has been looked at.
  bool rules_out(std::uint32_t first, std::uint32_t last) const;

  /// The segments of which it is certain, in the same way, that the fibre makes no loop between
  /// them and the one that starts at this point, nor any between.
  PointRange ruled_out_with(std::uint32_t point) const;

 private:
  struct Chain;
  struct Slot;
  class Within;

  bool is_within(std::uint32_t fiber, std::uint32_t point) const {
    return point < fibers_->offsets()[fiber + 1];
  }
  const Chain& chain(std::uint32_t fiber) const;
  bool leaves(const LoopReach& reach, PointRange points, std::uint64_t& loop_steps) const;
  bool fiber_makes_loop(PointPair pair, const SegmentDistance& nearest,
                        std::uint64_t& loop_steps) const;
  bool are_joined_by_graph(PointPair pair) const;
  bool all_ways_make_loops(PointPair pair, const SegmentDistance& nearest,
                           std::uint64_t& loop_steps) const;

  const FiberAssembly* fibers_ = nullptr;
  const FiberGraph* graph_ = nullptr;  // of these fibres, if they have one
  std::uint32_t max_points_ = 0;       // of a fibre
  mutable std::vector<Slot> slots_;    // by fibre; filled when asked for, most never are
  mutable std::mutex mutex_;           // of those that fill them
};

}  // namespace fiber
