#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/fiber_pair_minima.hpp"
#include "fiber_proximity/query/options.hpp"
#include "fiber_proximity/query/query_limits.hpp"

namespace fiber {

/// Keeps of the contacts it is given those the query asks for, and tells how close others must be
/// to matter. Whatever the bodies are: all queries keep their contacts here.
///
/// CLOSEST and LIMITED are one thing: keep the k closest, and let the bound below which a pair is
/// of interest shrink to the k-th of them. FIBER_PAIRS has such a bound for each pair of fibres;
/// the one for all stays the margin. A tolerance makes these bounds smaller than what has been
/// found. Where ALL and FIBER_PAIRS find more contacts than may be reported, they become such
/// queries too.
class ContactAccumulator {
 public:
  /// Holds references: options and result must outlive it. Forgets what is in the result.
  ContactAccumulator(const QueryOptions& options, QueryResult& result);

  /// [m] Pairs further apart than this do not matter any more.
  double bound() const { return bound_; }
  /// Whether contacts that are kept lower it.
  bool lowers_bound() const { return capacity_ != 0; }
  /// [m] The same, rounded up to single precision, as the bounding volumes take it.
  float rounded_bound() const { return rounded_bound_; }

  /// [m] Pairs of these fibres further apart than this do not matter any more.
  double bound_of(std::uint32_t fiber_a, std::uint32_t fiber_b);

  /// Whether one more pair may be examined; to be asked for each. Otherwise it is done.
  bool takes_pair() {
    if (pairs_left_ == 0) {
      reach_pair_limit();
      return false;
    }
    --pairs_left_;
    return true;
  }

  /// Counts looks along a fibre that a pair has taken: many are as much work as other pairs.
  void count_looks(std::uint64_t looks) {
    pairs_left_ -= std::min(pairs_left_, looks / QueryLimits::looks_per_pair);
  }

  /// Keeps a contact that is within the bound, or notes that it does not.
  void keep(const Contact& contact);

  /// Notes that a pair is not reported whose gap is at least this [m].
  void leave_out(double lower);

  /// No further pair can change the answer, or none may: the deadline has passed, or the limit of
  /// pairs is reached. To be asked often.
  bool done() {
    if (limits_.deadline.is_set() && ++steps_ % steps_between_looks == 0) {
      look_at_deadline();
    }
    return done_;
  }

  /// The order in which pairs are found matters for speed: near ones first. For FIBER_PAIRS it
  /// would save distances, but sorting costs more.
  bool wants_near_first() const { return capacity_ != 0; }

  /// Sorts the contacts; call once, at the end.
  /// @param least_gap [m] no pair at all has a smaller gap
  void finish(double least_gap);

 private:
  void keep_of_fibers(const Contact& contact);
  void keep_if_closest(const Contact& contact);
  void stay_within_limit();
  void set_bound(double bound);
  double slack(double distance) const;
  void look_at_deadline();
  void end_early();
  void reach_pair_limit();

  static constexpr std::uint32_t steps_between_looks = 32;  // looking takes as long as a few steps

  const QueryLimits limits_;
  std::uint64_t pairs_left_;
  FiberPairMinima minima_;  // FIBER_PAIRS only
  const QueryOptions& options_;
  QueryResult& result_;
  const std::size_t capacity_;  // of the k closest; 0 keeps all
  double bound_ = 0.0;          // [m]
  float rounded_bound_ = 0.0F;  // [m]
  bool done_ = false;
  std::uint32_t steps_ = 0;
};

}  // namespace fiber
