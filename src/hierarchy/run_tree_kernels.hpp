#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/hierarchy/pair_bound.hpp"

namespace fiber {

/// Segments in a run, and children of a node: the lanes of one AVX register of floats.
constexpr std::uint32_t run_width = 8;

/// Eight segments that follow each other along the space-filling curve [m], relative to the tree's
/// origin; by axis, then lane. Lanes without a segment repeat the last one.
struct alignas(32) Run {
  float start[3][run_width];
  float end[3][run_width];
  /// Padded so that every test on these segments errs on the safe side; infinite for a segment
  /// beyond the range of float, which is near everything.
  float radius[run_width];
};

/// How far the eight segments of a run move [m]: from that much before where the run has them to as
/// much beyond, all points of a segment alike; by how much they do not, its radius is larger.
struct alignas(32) RunDisplacement {
  float half[3][run_width];
};

/// Boxes of eight segments, runs or nodes [m]; by axis, then lane. Lanes without a child repeat the
/// last one.
struct alignas(32) BoxBlock {
  float lower[3][run_width];
  float upper[3][run_width];
};

/// Nodes of one level. Level 0 are groups, whose children are runs; the children of node n are
/// 8n … 8n + 7 one level down, as far as there are so many.
struct RunTreeLevel {
  const BoxBlock* boxes;  ///< of the children, by node
  std::uint32_t node_count;
  std::uint32_t child_count;  ///< of all nodes of the level

  /// The least first point of the segments of each child, by node. Lanes without a child
  /// have the largest number there is.
  const std::uint32_t* min_points;
};

/// A tree as the kernels read it.
struct RunTreeView {
  static constexpr std::uint32_t max_levels = 11;  // 8^11 runs are more than there can be

  const Run* runs = nullptr;
  const RunDisplacement* displacements = nullptr;  ///< of the runs; none where nothing moves
  /// First points of segments, along the curve; lanes without a segment repeat the last.
  const std::uint32_t* first_points = nullptr;
  std::uint32_t segment_count = 0;
  RunTreeLevel levels[max_levels] = {};
  std::uint32_t level_count = 0;

  std::uint32_t group_count() const { return level_count == 0 ? 0 : levels[0].node_count; }

  /// The least first point of a group's segments.
  std::uint32_t min_point(std::uint32_t group) const {
    const std::uint32_t* const of_runs = levels[0].min_points + std::size_t{group} * run_width;
    return *std::min_element(of_runs, of_runs + run_width);
  }
};

/// The bound of keys in a traversal of eight segments, or boxes of some, at a time.
struct KeyBound {
  bool self;  ///< pairs are of one assembly: the smaller point comes first
  std::uint64_t bound = PairBound::no_key;

  bool are_bounded() const { return bound != PairBound::no_key; }

  /// Bits of those of eight that may have pairs of smaller keys with what begins at this point.
  /// @param points the least first point of each
  std::uint32_t lanes(std::uint32_t least, const std::uint32_t* points) const {
    std::uint32_t bits = 0;
    for (std::uint32_t lane = 0; lane < run_width; ++lane) {
      const std::uint32_t other = points[lane];
      // No pair of these points or later ones has a smaller key.
      const std::uint64_t key = self ? pair_key({std::min(least, other), std::max(least, other)})
                                     : pair_key({least, other});
      bits |= key < bound ? 1U << lane : 0U;
    }
    return bits;
  }
};

/// A tree is fitted to these: fibres where they are, or with each point moving linearly from there
/// to where it is after. All is relative to an origin [m], which may move as well: what moves along
/// with it stands still.
struct TreeFibers {
  TreeFibers(const FiberAssembly& fibers, const Eigen::Vector3d& origin)
      : before(fibers), after(fibers), origin_before(origin), origin_after(origin) {}
  TreeFibers(const FiberAssembly& from, const FiberAssembly& to, const Eigen::Vector3d& origin_from,
             const Eigen::Vector3d& origin_to)
      : before(from), after(to), origin_before(origin_from), origin_after(origin_to), moves(true) {}

  const FiberAssembly& before;
  const FiberAssembly& after;
  Eigen::Vector3d origin_before;
  Eigen::Vector3d origin_after;
  bool moves = false;
};

/// Receives the candidates of a traversal.
class PairSink {
 public:
  virtual ~PairSink() = default;

  /// A pair of segments that may come within the bound, of a and of b.
  /// @return whether to go on
  virtual bool offer(PointPair pair) = 0;

  /// Which pairs matter (any more).
  virtual PairBound bound() const = 0;

  /// Whether pairs that are offered make the bound smaller: if so, they should not wait for others.
  virtual bool bound_shrinks() const = 0;

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
/// @param runs, displacements, boxes by run, by run, by group; no displacements of what does not
/// move
void fit_groups(const TreeFibers& fibers, const std::uint32_t* first_points,
                std::uint32_t segment_count, std::uint32_t begin, std::uint32_t end, Run* runs,
                RunDisplacement* displacements, BoxBlock* boxes);

/// Fits the nodes [begin, end) of a level above the groups to the boxes of the level below.
/// @param child_count of the whole level
void fit_nodes(const BoxBlock* boxes_below, std::uint32_t child_count, std::uint32_t begin,
               std::uint32_t end, BoxBlock* boxes);

/// The run that one comes to from the root by the child, of each node, that is nearest to the first
/// of these boxes.
std::uint32_t nearest_run(const RunTreeView& tree, const BoxBlock& boxes);

/// Offers every pair of segments of the groups [begin, end) of a and of all of b that may come
/// within the sink's bound; of one tree with itself, every pair of segments once. Which pairs are
/// offered beyond those that do come within it depends on the instruction set; their order does
/// not.
/// @param tests, overlaps boxes of nodes that were tested, and those that were near, are added to
/// these
/// @return whether the sink wanted to go on
FIBER_PROXIMITY_EXPORT bool find_near_segments(const RunTreeView& a, std::uint32_t begin,
                                               std::uint32_t end, const RunTreeView& b,
                                               PairSink& sink, std::uint64_t& tests,
                                               std::uint64_t& overlaps);

/// Does so group by group, as long as it is not over: where no candidates are, nobody else would
/// look at a clock.
template <class IsOver>
bool find_near_segments_until(const IsOver& is_over, const RunTreeView& a, std::uint32_t begin,
                              std::uint32_t end, const RunTreeView& b, PairSink& sink,
                              std::uint64_t& tests, std::uint64_t& overlaps) {
  for (std::uint32_t group = begin; group < end; ++group) {
    if (is_over() || !find_near_segments(a, group, group + 1, b, sink, tests, overlaps)) {
      return false;
    }
  }
  return true;
}

}  // namespace fiber
