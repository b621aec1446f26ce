#pragma once

#include <Eigen/Core>
#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/point_pair.hpp"
#include "fiber_proximity/hierarchy/query_counts.hpp"
#include "src/hierarchy/run_blocks.hpp"
#include "src/hierarchy/tree_fibers.hpp"

namespace fiber {

/// What receives the candidates of a traversal.
class PairSink {
 public:
  virtual ~PairSink() = default;

  /// A pair of segments that may come within the bound, of a and of b.
  /// @return whether to go on
  virtual bool offer(PointPair pair) = 0;

  /// [m] Pairs further apart than this do not matter (any more).
  virtual float bound() const = 0;

  /// Whether segments that share a point are pairs. Every segment is near its neighbours: if they
  /// are not wanted, they should go early.
  virtual bool wants_adjacent() const = 0;

  /// Segments of which it is certain, at little cost, that they are no pairs with the one that
  /// starts at this point, nor with any between.
  virtual PointRange ruled_out_with(std::uint32_t point) const = 0;
};

/// Fits the runs of groups [begin, end): their segments and boxes, which hold all that segments
/// that move come by.
/// @param first_points of all segments, along the curve
/// @param runs, ways, boxes by run, by run, by group; no ways of what does not move
void fit_groups(const TreeFibers& fibers, const std::uint32_t* first_points,
                std::uint32_t segment_count, std::uint32_t begin, std::uint32_t end, Run* runs,
                RunWays* ways, BoxBlock* boxes);

/// Fits the nodes [begin, end) of a level above the groups to the boxes of the level below.
/// @param child_count of the whole level
void fit_nodes(const BoxBlock* boxes_below, std::uint32_t child_count, std::uint32_t begin,
               std::uint32_t end, BoxBlock* boxes);

/// Offers every pair of segments of the groups [begin, end) of a and of all of b that may come
/// within the sink's bound; of one tree with itself, every pair of segments once. Which pairs are
/// offered beyond those that do come within it depends on the instruction set; their order does
/// not.
/// @return whether the sink wanted to go on
bool find_near_segments(const RunTreeView& a, std::uint32_t begin, std::uint32_t end,
                        const RunTreeView& b, PairSink& sink, QueryCounts& counts);

}  // namespace fiber
