#pragma once

#include <cstdint>
#include <optional>

#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "src/mpi/joined_fibers.hpp"

namespace fiber {

/// Decides which segments of closed and joined fibres are no pair, as one process that has all
/// fibres decides. Chains are not asked about here.
class JoinedPairs {
 public:
  JoinedPairs(const JoinedFibers& joined, const PairOptions& options) : joined_(joined) {
    static_cast<PairOptions&>(options_) = options;
    if (joined.fibers().fiber_count() > 0) {
      test_.emplace(joined.fibers(), options_, &joined.loops());
    }
  }
  JoinedPairs(const JoinedPairs&) = delete;
  JoinedPairs& operator=(const JoinedPairs&) = delete;

  /// The places of two segments among the joined fibres, none if this does not decide about them.
  /// @param a the one that comes first
  std::optional<PointPair> points_of(const GlobalSegment& a, const GlobalSegment& b) const {
    return test_ ? joined_.points_of(a, b) : std::nullopt;
  }

  /// Whether they are no pair.
  /// @param pair       from points_of()
  /// @param loop_steps as LoopTest::makes_loop() has them
  bool are_left_out(PointPair pair, std::uint64_t& loop_steps) const {
    return test_->is_left_out(pair) || test_->lacks_loop(pair, test_->distance(pair), loop_steps);
  }
  bool are_left_out(PointPair pair) const {
    std::uint64_t loop_steps = 0;
    return are_left_out(pair, loop_steps);
  }

 private:
  const JoinedFibers& joined_;
  QueryOptions options_;
  std::optional<NarrowPhase> test_;  // none without joined fibres
};

}  // namespace fiber
