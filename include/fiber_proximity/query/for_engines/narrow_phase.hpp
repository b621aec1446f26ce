#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/for_engines/loop_test.hpp"
#include "fiber_proximity/query/options.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Nearest points of two segments, and the signed gap of their surfaces [m].
struct PairDistance {
  SegmentDistance nearest;
  double gap = 0.0;
};

/// The contact of two segments that are so far apart, but for the names of their fibres.
Contact contact_of(const Capsule& a, const Capsule& b, const SegmentDistance& nearest);

/// The one narrow phase: which pairs of segments count, how far apart they are, what is reported of
/// them. Holds references: assemblies and options must outlive it.
class NarrowPhase {
 public:
  /// Pairs within one assembly.
  /// @param loops of these fibres, if somebody keeps them; otherwise what is known of their loops
  ///              is found anew
  NarrowPhase(const FiberAssembly& fibers, const QueryOptions& options,
              const LoopTest* loops = nullptr);
  /// Pairs of a shape and the fibres.
  NarrowPhase(const FiberAssembly& shape, const FiberAssembly& fibers, const QueryOptions& options);

  /// The pair with its smaller index first, within one assembly.
  PointPair ordered(PointPair pair) const {
    return self_ && pair.b < pair.a ? PointPair{pair.b, pair.a} : pair;
  }

  /// Whether segments that share a point are pairs.
  bool wants_adjacent() const { return !self_ || neighbour_skip_ == 0; }

  /// Whether this ordered pair is left out: by the neighbour skips, along the shortest way of the
  /// graph, or the pairing. Where points are changes this only through neighbour_skip_length.
  bool is_left_out(PointPair pair) const {
    const bool far_by_index = pair.b - pair.a > neighbour_skip_;
    return self_ && ((!(far_by_index && index_decides_) && is_neighbour(pair)) ||
                     (options_.pairing != Pairing::ALL &&
                      is_of_one_fiber(pair) != (options_.pairing == Pairing::SAME_FIBER)));
  }

  /// Whether this ordered pair that is not left out is none all the same: the options need loops,
  /// and a way from one of these segments to the other makes none.
  /// @param loop_steps as LoopTest::makes_loop() has them
  bool lacks_loop(PointPair pair, const PairDistance& distance, std::uint64_t& loop_steps) const {
    return loops_ != nullptr && loops_->are_joined(pair) &&
           !loops_->makes_loop(pair, distance.nearest, loop_steps);
  }
  /// lacks_loop() where the distance is not known yet.
  bool lacks_loop(PointPair pair) const {
    return loops_ != nullptr && loops_->are_joined(pair) &&
           !loops_->makes_loop(pair, distance(pair).nearest);
  }

  /// Whether it is certain that a loop is lacking; see LoopTest.
  bool rules_out(std::uint32_t first, std::uint32_t last) const {
    return loops_ != nullptr && loops_->rules_out(first, last);
  }
  PointRange ruled_out_with(std::uint32_t point) const {
    return loops_ != nullptr ? loops_->ruled_out_with(point) : PointRange{};
  }

  /// By the kernel ROBUST.
  PairDistance distance(PointPair pair) const;
  /// distance() of many pairs, faster.
  void distances(const PointPair* pairs, std::size_t count, PairDistance* distances) const;

  /// Whether the gap is at most the margin: of ROBUST the one computed, otherwise the true one.
  bool is_within_margin(PointPair pair, const PairDistance& distance) const;

  /// [m] The true gap is at least this.
  double gap_lower(PointPair pair, const PairDistance& distance) const;

  double margin() const { return options_.margin; }  ///< [m]

  /// [m] No gap is less.
  double min_gap() const;

  /// [m] No gap that is computed or reported is less: axes can do no more than meet.
  double min_computed_gap() const { return -(a_.largest_radius() + b_.largest_radius()); }

  /// [m] distance(pair).gap is at least this, its rounding included; costs a fraction of it.
  double gap_lower_bound(PointPair pair) const;

  /// The contact of a pair; with EXACT its distance is rounded correctly.
  Contact contact(PointPair pair, const PairDistance& distance) const;

 private:
  bool is_neighbour(PointPair pair) const;
  bool is_of_one_fiber(PointPair pair) const {
    return a_.segment_id(pair.a).fiber == a_.segment_id(pair.b).fiber;
  }
  double radii(PointPair pair) const {
    return a_.segment_radius(pair.a) + b_.segment_radius(pair.b);
  }

  const FiberAssembly& a_;
  const FiberAssembly& b_;
  const QueryOptions& options_;
  const bool self_;
  const std::uint32_t neighbour_skip_;
  const double neighbour_skip_length_;  // [m]
  std::optional<LoopTest> own_loops_;
  const LoopTest* loops_ = nullptr;  // none where the options do not need them
  std::vector<double> arc_length_;   // [m] by point, from its fibre's start; empty if not needed
  // Whether segments whose indices differ by more than the skip are no neighbours.
  bool index_decides_ = true;
};

}  // namespace fiber
