#pragma once

#include <cstdint>
#include <optional>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/contact_accumulator.hpp"
#include "fiber_proximity/query/narrow_phase.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// Receives candidate pairs of segments, decides which are contacts, keeps those the query asks
/// for. Every engine and brute force feed this one class, so a pair is judged in one place.
///
/// The bounds of FIBER_PAIRS are used here alone: bound() knows no fibres and stays the margin.
class PairCollector {
 public:
  /// Pairs within one assembly.
  /// @param loops as NarrowPhase takes them
  PairCollector(const FiberAssembly& fibers, const QueryOptions& options, QueryResult& result,
                const LoopTest* loops = nullptr);
  /// Pairs of a shape and the fibres.
  PairCollector(const FiberAssembly& shape, const FiberAssembly& fibers,
                const QueryOptions& options, QueryResult& result);

  /// Considers the segments that start at these points: of the assembly in any order, or of the
  /// shape and of the fibres. Each pair may be offered once.
  void offer(std::uint32_t point_a, std::uint32_t point_b);

  /// [m] Pairs further apart than this do not matter any more; rounded up to single precision, as
  /// the bounding volumes take it.
  float bound() const { return accumulator_.rounded_bound(); }

  bool wants_adjacent() const { return test_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const { return test_.ruled_out_with(point); }

  /// See ContactAccumulator.
  bool done() { return accumulator_.done(); }
  bool wants_near_first() const { return accumulator_.wants_near_first(); }

  /// Sorts the contacts; call once, after the last offer.
  void finish() { accumulator_.finish(test_.least_gap()); }

 private:
  /// Finds the fibre of a point; at once if it is that of the point before.
  class FiberFinder {
   public:
    explicit FiberFinder(const FiberAssembly& fibers) : fibers_(fibers) {}
    std::uint32_t fiber_of(std::uint32_t point);

   private:
    const FiberAssembly& fibers_;
    std::uint32_t fiber_ = 0;
    std::uint32_t begin_ = 0;  // of its points; none yet
    std::uint32_t end_ = 0;
  };

  void offer_of_fibers(PointPair pair);
  std::optional<Contact> contact_within(PointPair pair, double bound);

  ContactAccumulator accumulator_;  // first: its time begins, and the test takes time to make
  const NarrowPhase test_;
  FiberFinder fibers_a_;
  FiberFinder fibers_b_;
  const QueryOptions& options_;
  QueryCounts& counts_;
};

}  // namespace fiber
