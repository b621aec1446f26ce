#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/simplified_fibers.hpp"
#include "fiber_proximity/query/pair_collector.hpp"
#include "fiber_proximity/query/pair_test.hpp"

namespace fiber {

/// The pairs of segments of one fibre that pieces cannot stand for: of a piece with itself, and of
/// two pieces whose runs hold neighbours. These pairs are looked for among the segments themselves,
/// along each fibre. Holds references: fibres, simplified ones and options must outlive it.
class UnsimplifiedPairs {
 public:
  UnsimplifiedPairs(const FiberAssembly& fibers, const SimplifiedFibers& simplified,
                    const QueryOptions& options);

  /// Pairs of pieces of one fibre whose indices differ by at most this are left to offer(); of all
  /// others no two segments are neighbours.
  std::uint32_t neighbour_skip() const { return neighbour_skip_; }

  /// Offers the segments of these pieces, but for those further apart than the collector's bound.
  void offer(PairCollector& collector);

 private:
  /// All pairs of a segment of a piece, and one that follows it up to the end.
  struct Window {
    std::uint32_t piece;
    std::uint32_t end;    // one past the last segment
    std::uint32_t first;  // segment after the piece's first one that is no neighbour of it
  };

  std::uint32_t window_end(std::uint32_t piece, std::uint32_t fiber) const;
  bool are_far(const Window& window, double bound) const;
  void offer_within(const Window& window, PairCollector& collector);
  std::uint32_t first_far(std::uint32_t segment, std::uint32_t from, std::uint32_t end) const;

  const FiberAssembly& fibers_;
  const SimplifiedFibers& simplified_;
  const PairTest test_;
  const bool wants_adjacent_;
  std::uint32_t neighbour_skip_ = 0;
  std::vector<double> least_;  // [m] work memory of offer_within()
};

}  // namespace fiber
