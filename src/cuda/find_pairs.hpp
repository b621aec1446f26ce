#pragma once

#include <cstdint>

#include "src/cuda/candidates.hpp"
#include "src/cuda/segment_tree.hpp"

namespace fiber {

/// Which pairs of segments are looked for.
struct PairRule {
  bool self = true;    ///< pairs of one tree with itself, each once, the smaller first point first
  float bound = 0.0F;  ///< [m] whose surfaces may come within this
  /// Only pairs of one tree: those of one fibre whose indices differ by at most this are none.
  std::uint32_t neighbour_skip = 0;
  bool same_fiber = true;        ///< whether pairs of one fibre are wanted
  bool different_fibers = true;  ///< and those of two
  bool with_itself = true;       ///< whether pairs of one candidate are wanted at all
};

/// Looks for the pairs of leaves of one tree, a warp each, with all of another; or of one tree with
/// itself, where pairs with earlier leaves are left to those.
///
/// A warp goes down the other tree with the box around its leaf, a lane a child; the children that
/// are near wait on a stack. At a leaf each of its segments is held against that leaf's box, and
/// each of the other's against the warp's; then the warp runs over the fewer of the two. Pairs
/// whose boxes overlap wait in a queue until every lane has one for the test of distance.
/// @tparam Taker what becomes of them: WritePairs has what it can
template <class Taker>
struct FindPairs {
  struct Scratch {
    // Each level leaves at most 31 nodes on the stack while it is gone down from the last.
    std::uint32_t stack[31 * SegmentTreeView::max_levels + 2];
    TreeSegment mine[warp_width];
    TreeBox ones[warp_width];
    std::uint32_t boxes_near[2 * warp_width];  // the two queues
    std::uint32_t lines_near[2 * warp_width];
  };

  SegmentTreeView a;
  SegmentTreeView b;
  PairRule rule;
  const std::uint32_t* fibers;  ///< by first point; those of the one tree, for the rule
  CandidateView candidates;     ///< of the one tree, if it has any
  std::uint32_t first_leaf;     ///< of a: that of the first warp
  Taker taker;

  template <class Warp>
  FIBER_ON_DEVICE void operator()(Warp warp, std::uint32_t index, Scratch& scratch) const {
    Search<Warp>(*this, warp, first_leaf + index, scratch).run();
  }

 private:
  static constexpr std::uint32_t place_mask = SegmentTreeView::max_segments - 1;
  static constexpr int place_bits = SegmentTreeView::place_bits;

  template <class Warp>
  class Search {
   public:
    FIBER_ON_DEVICE Search(const FindPairs& what, Warp warp, std::uint32_t leaf, Scratch& scratch)
        : what_(what), warp_(warp), leaf_(leaf), scratch_(scratch) {}

    FIBER_ON_DEVICE void run() {
      const SegmentTreeView& a = what_.a;
      warp_.each([&](int lane) {
        const TreeSegment segment = a.segments[smaller(place(leaf_, lane), a.segment_count - 1)];
        scratch_.mine[lane] = segment;
        mine_[lane] = box_of(segment, what_.rule.bound);
      });
      whole_ = warp_.reduce(mine_, [](TreeBox& x, const TreeBox& y) { x.take(y); });
      warp_.sync();
      find_candidates();
      int size = 0;
      leaves_.each_start(
          leaf_, what_.b.box_counts[0], what_.b.level_count, [&](int level, std::uint32_t node) {
            warp_.each([&](int lane) {
              if (lane == 0) {
                scratch_.stack[size] = static_cast<std::uint32_t>(level) << place_bits | node;
              }
            });
            ++size;
          });
      warp_.sync();
      while (size > 0 && !what_.taker.is_over(warp_, first_candidate_, last_candidate_)) {
        --size;
        const std::uint32_t entry = scratch_.stack[size];
        warp_.sync();
        const int level = static_cast<int>(entry >> place_bits);
        const std::uint32_t node = entry & place_mask;
        if (level > 0) {
          size = go_down(level - 1, node, size);
        } else {
          meet_leaf(node);
        }
      }
      test_lines();
      test_segments();
    }

   private:
    FIBER_ON_DEVICE static std::uint32_t place(std::uint32_t node, int lane) {
      return node * warp_width + static_cast<std::uint32_t>(lane);
    }
    FIBER_ON_DEVICE static std::uint32_t smaller(std::uint32_t x, std::uint32_t y) {
      return x < y ? x : y;
    }

    FIBER_ON_DEVICE std::uint32_t candidate_of(std::uint32_t point) const {
      return what_.candidates.of_fibers[what_.fibers[point]];
    }

    /// Which candidates the leaf is of, and where in the tree is what they may meet.
    FIBER_ON_DEVICE void find_candidates() {
      const CandidateView& candidates = what_.candidates;
      if (!candidates.exist()) {
        return;
      }
      first_candidate_ = candidate_of(scratch_.mine[0].point);
      last_candidate_ = candidate_of(scratch_.mine[warp_width - 1].point);
      leaves_.own_end = what_.rule.with_itself
                            ? (candidates.end_of(last_candidate_) + warp_width - 1) / warp_width
                            : 0U;
      if (candidates.segment_end < what_.b.segment_count) {
        leaves_.still_begin = candidates.segment_end / warp_width;
      }
    }

    /// By value: a choice of references would keep both in memory.
    FIBER_ON_DEVICE static TreeBox chosen(bool first, const TreeBox& x, const TreeBox& y) {
      TreeBox box{};
      for (int axis = 0; axis < 3; ++axis) {
        box.lower[axis] = first ? x.lower[axis] : y.lower[axis];
        box.upper[axis] = first ? x.upper[axis] : y.upper[axis];
      }
      return box;
    }

    /// Puts the near ones of a node's children, which are of this level, onto the stack.
    FIBER_ON_DEVICE int go_down(int level, std::uint32_t node, int size) {
      const TreeBox* const boxes = what_.b.boxes[level];
      const std::uint32_t count = what_.b.box_counts[level];
      constexpr int bits_per_level = CandidateLeaves::bits_per_level;
      const std::uint32_t near = warp_.ballot([&](int lane) {
        const std::uint32_t child = place(node, lane);
        // The leaves below it end here; all earlier ones than this look for it themselves.
        const std::uint64_t begin = std::uint64_t{child} << (bits_per_level * level);
        const std::uint64_t end = (std::uint64_t{child} + 1) << (bits_per_level * level);
        const TreeBox box = boxes[smaller(child, count - 1)];
        return child < count && (!what_.rule.self || end > leaf_) && leaves_.meet(begin, end) &&
               overlap(whole_, box);
      });
      warp_.each([&](int lane) {
        if ((near & bit_of(lane)) != 0) {
          scratch_.stack[size + count_bits(near & bits_before(lane))] =
              static_cast<std::uint32_t>(level) << place_bits | place(node, lane);
        }
      });
      warp_.sync();
      return size + count_bits(near);
    }

    FIBER_ON_DEVICE void meet_leaf(std::uint32_t other) {
      const SegmentTreeView& b = what_.b;
      typename Warp::template PerLane<TreeBox> theirs;
      warp_.each([&](int lane) {
        const TreeSegment segment = b.segments[smaller(place(other, lane), b.segment_count - 1)];
        theirs[lane] = box_of(segment, 0.0F);
      });
      const TreeBox around = b.boxes[0][other];
      const std::uint32_t near_mine = warp_.ballot([&](int lane) {
        return place(leaf_, lane) < what_.a.segment_count && overlap(mine_[lane], around);
      });
      const std::uint32_t near_theirs = warp_.ballot([&](int lane) {
        return place(other, lane) < b.segment_count && overlap(theirs[lane], whole_);
      });
      const bool over_theirs = count_bits(near_theirs) <= count_bits(near_mine);
      const std::uint32_t lanes = over_theirs ? near_mine : near_theirs;
      const bool is_own = what_.rule.self && other == leaf_;
      typename Warp::template PerLane<TreeBox> held;
      typename Warp::template PerLane<std::uint32_t> hits;
      warp_.each([&](int lane) {
        scratch_.ones[lane] = chosen(over_theirs, theirs[lane], mine_[lane]);
        held[lane] = chosen(over_theirs, mine_[lane], theirs[lane]);
        hits[lane] = 0;
      });
      warp_.sync();
      // One by one, against what the lanes hold: a bit of each lane's hits.
      for (std::uint32_t rest = over_theirs ? near_theirs : near_mine; rest != 0;
           rest &= rest - 1) {
        const int one = lowest_bit(rest);
        const TreeBox box = scratch_.ones[one];
        warp_.each([&](int lane) { hits[lane] |= overlap(held[lane], box) ? bit_of(one) : 0U; });
      }
      warp_.sync();
      // Of one leaf each pair is met twice.
      warp_.each([&](int lane) {
        const std::uint32_t wanted = is_own ? bits_before(lane) : ~0U;
        hits[lane] &= (lanes & bit_of(lane)) != 0 ? wanted : 0U;
      });
      queue_hits(other, over_theirs, hits);
    }

    /// Lets the pairs wait whose boxes overlap, one of each lane at a time.
    FIBER_ON_DEVICE void queue_hits(std::uint32_t other, bool over_theirs,
                                    typename Warp::template PerLane<std::uint32_t>& hits) {
      for (;;) {
        const std::uint32_t lanes = warp_.ballot([&](int lane) { return hits[lane] != 0; });
        if (lanes == 0) {
          return;
        }
        put(scratch_.boxes_near, boxes_waiting_, lanes, [&](int lane) {
          const int one = lowest_bit(hits[lane]);
          return static_cast<std::uint32_t>(over_theirs ? lane : one) << place_bits |
                 place(other, over_theirs ? one : lane);
        });
        warp_.each([&](int lane) { hits[lane] &= hits[lane] - 1; });
        if (boxes_waiting_ >= warp_width) {
          test_lines();
        }
      }
    }

    /// Puts entries of these lanes into a queue.
    template <class Entry>
    FIBER_ON_DEVICE void put(std::uint32_t* queue, int& waiting, std::uint32_t lanes,
                             const Entry& entry) {
      warp_.each([&](int lane) {
        if ((lanes & bit_of(lane)) != 0) {
          queue[waiting + count_bits(lanes & bits_before(lane))] = entry(lane);
        }
      });
      waiting += count_bits(lanes);
      warp_.sync();
    }

    /// Takes the last entries out of a queue, a warp's worth at most.
    /// @return how many; they stand where it ends now, until something is put there
    FIBER_ON_DEVICE static int take_last(int& waiting) {
      const int size = waiting < warp_width ? waiting : warp_width;
      waiting -= size;
      return size;
    }

    /// Lets those of the last pairs wait further whose lines are near.
    FIBER_ON_DEVICE void test_lines() {
      const int size = take_last(boxes_waiting_);
      const std::uint32_t* const pairs = scratch_.boxes_near + boxes_waiting_;
      const std::uint32_t near = warp_.ballot([&](int lane) {
        if (lane >= size) {
          return false;
        }
        const Pair pair(*this, pairs[lane]);
        return is_pair(pair.mine.point, pair.other.point) && pair.lines_are_near();
      });
      if (near != 0) {
        put(scratch_.lines_near, lines_waiting_, near, [&](int lane) { return pairs[lane]; });
      }
      warp_.sync();
      if (lines_waiting_ >= warp_width) {
        test_segments();
      }
    }

    /// Has those of the last pairs taken that may be near.
    FIBER_ON_DEVICE void test_segments() {
      const int size = take_last(lines_waiting_);
      const std::uint32_t* const pairs = scratch_.lines_near + lines_waiting_;
      const std::uint32_t near = warp_.ballot(
          [&](int lane) { return lane < size && Pair(*this, pairs[lane]).segments_are_near(); });
      if (near != 0) {
        what_.taker.take(warp_, near, [&](int lane) {
          const Pair pair(*this, pairs[lane]);
          return key_of(pair.mine.point, pair.other.point);
        });
      }
      warp_.sync();
    }

    FIBER_ON_DEVICE std::uint64_t key_of(std::uint32_t x, std::uint32_t y) const {
      return what_.rule.self && y < x ? std::uint64_t{y} << 32U | x : std::uint64_t{x} << 32U | y;
    }

    FIBER_ON_DEVICE bool is_pair(std::uint32_t x, std::uint32_t y) const {
      const PairRule& rule = what_.rule;
      if (!rule.self) {
        return true;
      }
      if (what_.candidates.exist()) {
        const bool x_stands = x >= what_.candidates.point_end;
        const bool y_stands = y >= what_.candidates.point_end;
        if (x_stands || y_stands) {
          return x_stands != y_stands;
        }
        if (!rule.with_itself || candidate_of(x) != candidate_of(y)) {
          return false;
        }
      }
      const std::uint32_t apart = x < y ? y - x : x - y;
      if (apart > rule.neighbour_skip && rule.same_fiber && rule.different_fibers) {
        return true;
      }
      const bool is_same = what_.fibers[x] == what_.fibers[y];
      return is_same ? rule.same_fiber && apart > rule.neighbour_skip : rule.different_fibers;
    }

    /// Two segments, as a queue tells of them.
    struct Pair {
      const TreeSegment mine;
      const TreeSegment other;
      const float bound;

      FIBER_ON_DEVICE Pair(const Search& search, std::uint32_t entry)
          : mine(search.scratch_.mine[entry >> place_bits]),
            other(search.what_.b.segments[entry & place_mask]),
            bound(search.what_.rule.bound) {}

      FIBER_ON_DEVICE static one_lane::LaneVector vector(const float (&values)[3]) {
        return {values[0], values[1], values[2]};
      }
      FIBER_ON_DEVICE float reach() const { return mine.radius + other.radius + bound; }

      FIBER_ON_DEVICE bool lines_are_near() const {
        const one_lane::LaneVector p = vector(mine.start);
        const one_lane::LaneVector q = vector(other.start);
        return one_lane::lines_near(one_lane::subtract(vector(mine.end), p),
                                    one_lane::subtract(vector(other.end), q),
                                    one_lane::subtract(p, q), reach());
      }
      FIBER_ON_DEVICE bool segments_are_near() const {
        return one_lane::segments_near(
            one_lane::lane_segments(vector(mine.start), vector(mine.end)),
            one_lane::lane_segments(vector(other.start), vector(other.end)), reach());
      }
    };

    const FindPairs& what_;
    Warp warp_;
    const std::uint32_t leaf_;
    Scratch& scratch_;
    typename Warp::template PerLane<TreeBox> mine_;
    TreeBox whole_{};
    int boxes_waiting_ = 0;
    int lines_waiting_ = 0;
    CandidateLeaves leaves_;
    std::uint32_t first_candidate_ = 0;
    std::uint32_t last_candidate_ = 0;
  };
};

}  // namespace fiber
