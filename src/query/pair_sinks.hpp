#pragma once

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/bounds/bounding_volume.hpp"
#include "src/hierarchy/motion_since_fit.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"

namespace fiber {

/// [m] That of a pair whose gap is this one by now, rounded up.
inline float gap_before(float gap, const Approach& approach) {
  return approach.is_none() ? gap : round_up(approach.before(gap));
}

/// Hands candidates to a collector one by one: for the queries whose bound shrinks.
class CollectorSink : public PairSink {
 public:
  /// @param approach of pairs since the trees have had them
  CollectorSink(PairCollector& collector, const Approach& approach)
      : collector_(collector), approach_(approach) {}

  bool offer(PointPair pair) override {
    collector_.offer(pair.a, pair.b);
    return !collector_.done();
  }

  PairBound bound() const override {
    const float gap = collector_.gap_bound();
    return {gap_before(gap, approach_), collector_.key_bound()};
  }

  bool bound_shrinks() const override { return true; }

  bool wants_adjacent() const override { return collector_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const override {
    return collector_.ruled_out_with(point);
  }

 private:
  PairCollector& collector_;
  const Approach approach_;
};

/// Hands on what another sink is offered, of trees whose pairs may be nearer than they have them.
class WideningSink final : public PairSink {
 public:
  WideningSink(PairSink& sink, const Approach& approach) : sink_(sink), approach_(approach) {}

  bool offer(PointPair pair) override { return sink_.offer(pair); }
  PairBound bound() const override {
    const PairBound bound = sink_.bound();
    return {gap_before(bound.gap, approach_), bound.key};
  }
  bool bound_shrinks() const override { return sink_.bound_shrinks(); }
  bool wants_adjacent() const override { return sink_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const override {
    return sink_.ruled_out_with(point);
  }

 private:
  PairSink& sink_;
  const Approach approach_;
};

}  // namespace fiber
