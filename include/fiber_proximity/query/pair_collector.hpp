#pragma once

#include <cstdint>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/fiber_pair_minima.hpp"
#include "fiber_proximity/query/options.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// Receives candidate pairs of segments, decides which are contacts, keeps those the query asks
/// for. Every engine and brute force feed this one class, so a pair is judged in one place.
///
/// CLOSEST and LIMITED are one thing: keep the k closest, and let the bound below which a pair is
/// of interest shrink to the k-th of them. FIBER_PAIRS has such a bound for each pair of fibres,
/// and uses it here alone: bound() knows no fibres and stays the margin.
class PairCollector {
 public:
  /// Pairs within one assembly.
  PairCollector(const FiberAssembly& fibers, const QueryOptions& options, QueryResult& result);
  /// Pairs of a shape and the fibres.
  PairCollector(const FiberAssembly& shape, const FiberAssembly& fibers,
                const QueryOptions& options, QueryResult& result);

  /// Considers the segments that start at these points: of the assembly in any order, or of the
  /// shape and of the fibres. Each pair may be offered once.
  void offer(std::uint32_t point_a, std::uint32_t point_b);

  /// [m] Pairs further apart than this do not matter any more; rounded up to single precision, as
  /// the bounding volumes take it.
  float bound() const { return rounded_bound_; }

  bool wants_adjacent() const { return test_.wants_adjacent(); }

  /// No further pair can change the answer.
  bool done() const { return done_; }

  /// The order in which pairs are offered matters for speed: near ones first. For FIBER_PAIRS it
  /// would save distances, but sorting costs more.
  bool wants_near_first() const { return capacity_ != 0; }

  /// Sorts the contacts; call once, after the last offer.
  void finish();

 private:
  PairCollector(PairTest&& test, const FiberPairMinima& minima, const QueryOptions& options,
                QueryResult& result);

  void offer_to_minima(PointPair pair);
  void keep(const Contact& contact);
  void set_bound(double bound);

  const PairTest test_;
  FiberPairMinima minima_;  // FIBER_PAIRS only
  const QueryOptions& options_;
  QueryResult& result_;
  const std::size_t capacity_;  // of the k closest; 0 keeps all
  double bound_ = 0.0;          // [m]
  float rounded_bound_ = 0.0F;  // [m]
  bool done_ = false;
};

}  // namespace fiber
