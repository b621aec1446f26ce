#pragma once

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/bounds/bounding_volume.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"

namespace fiber {

/// Hands candidates to a collector one by one: for the queries whose bound shrinks.
class CollectorSink : public PairSink {
 public:
  /// @param moved [m] by how much pairs may be nearer than the trees have them
  CollectorSink(PairCollector& collector, double moved)
      : collector_(collector), moved_(round_up(moved)) {}

  bool offer(PointPair pair) override {
    collector_.offer(pair.a, pair.b);
    return !collector_.done();
  }

  PairBound bound() const override {
    const float gap = collector_.gap_bound();
    return {moved_ == 0.0F ? gap : round_up(double{gap} + moved_), collector_.key_bound()};
  }

  bool bound_shrinks() const override { return true; }

  bool wants_adjacent() const override { return collector_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const override {
    return collector_.ruled_out_with(point);
  }

 private:
  PairCollector& collector_;
  const float moved_;
};

/// Hands on what another sink is offered, of trees whose pairs may be nearer than they have them.
class WideningSink final : public PairSink {
 public:
  /// @param moved [m] by how much
  WideningSink(PairSink& sink, double moved) : sink_(sink), moved_(moved) {}

  bool offer(PointPair pair) override { return sink_.offer(pair); }
  PairBound bound() const override {
    const PairBound bound = sink_.bound();
    return {moved_ == 0.0 ? bound.gap : round_up(double{bound.gap} + moved_), bound.key};
  }
  bool bound_shrinks() const override { return sink_.bound_shrinks(); }
  bool wants_adjacent() const override { return sink_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const override {
    return sink_.ruled_out_with(point);
  }

 private:
  PairSink& sink_;
  const double moved_;
};

}  // namespace fiber
