#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "fiber_proximity/query/options.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// The cost that the options of a query allow: where it stops, and how much it may report. A
/// limit that is not set is one that nothing reaches.
struct QueryLimits {
  explicit QueryLimits(const QueryOptions& options)
      : deadline(options.deadline),
        pairs(options.pair_limit == 0 ? std::numeric_limits<std::uint64_t>::max()
                                      : options.pair_limit),
        contacts(max_reported(options)),
        max_kept(std::max(2 * contacts, contacts + min_surplus)) {}

  Deadline deadline;
  std::uint64_t pairs;     ///< to be examined
  std::uint64_t contacts;  ///< to be reported

  /// Contacts that are kept at a time: so many more than reported that it is rarely asked which of
  /// them are the closest.
  std::uint64_t max_kept;

  /// So many steps along a fibre (LoopTest) cost as much as one more pair, and count as one.
  static constexpr std::uint64_t loop_steps_per_pair = 8;

  static constexpr std::uint64_t min_surplus = 1024;

 private:
  static std::uint64_t max_reported(const QueryOptions& options) {
    constexpr std::uint32_t none = std::numeric_limits<std::uint32_t>::max();
    const std::uint32_t limit = options.contact_limit == 0 ? none : options.contact_limit;
    return options.type == QueryType::LIMITED ? std::min(options.max_contacts, limit) : limit;
  }
};

/// The closest contact of each pair of fibres so far, among the contacts of a result.
///
/// A hash table with linear probing finds a pair's contact. Traversals find the pairs of two fibres
/// in a row, so the last pair of fibres is remembered and most look-ups need no table. Holds a
/// reference: the result must outlive it. Until the first keep() it costs nothing.
class FiberPairMinima {
 public:
  explicit FiberPairMinima(QueryResult& result)
      : contacts_(result.contacts), slots_(result.fiber_pair_slots) {}
  /// For a part of a search: finds what the whole has kept, too, and keeps nothing there.
  FiberPairMinima(const FiberPairMinima& whole, QueryResult& result)
      : whole_(&whole), contacts_(result.contacts), slots_(result.fiber_pair_slots) {}
  FiberPairMinima(const FiberPairMinima&) = delete;
  FiberPairMinima& operator=(const FiberPairMinima&) = delete;

  /// The closest contact so far of these fibres, nullptr if there is none.
  const Contact* find(std::uint32_t fiber_a, std::uint32_t fiber_b);

  /// Keeps a contact of the pair last looked for, unless one is kept that is closer, or as close
  /// and of smaller indices.
  void keep(const Contact& contact);

  /// To be called when some contacts have been taken out of the result, or have changed places.
  void contacts_have_moved();

 private:
  Contact* look_up(std::uint32_t fiber_a, std::uint32_t fiber_b) const;
  std::size_t slot_of(std::uint32_t fiber_a, std::uint32_t fiber_b) const;
  void grow();
  void fill_slots();

  const FiberPairMinima* whole_ = nullptr;
  std::vector<Contact>& contacts_;
  std::vector<std::uint32_t>& slots_;       // index of a contact + 1, 0 where free
  Contact* last_ = nullptr;                 // of the last look-up
  const Contact* last_of_whole_ = nullptr;  // the same
  // Its fibres; none yet.
  std::uint32_t last_a_ = std::numeric_limits<std::uint32_t>::max();
  std::uint32_t last_b_ = std::numeric_limits<std::uint32_t>::max();
};

/// Keeps of the contacts it is given those the query asks for, and tells how close others must be
/// to matter. Whatever the bodies are: all queries keep their contacts here.
///
/// CLOSEST and LIMITED are one thing: keep the k closest, and let the bound below which a pair is
/// of interest shrink to the k-th of them, in penetration, too. FIBER_PAIRS has such a bound for
/// each pair of fibres; the one for all stays the margin. A tolerance makes these bounds smaller
/// than what has been found. Where ALL and FIBER_PAIRS find more contacts than may be reported,
/// they become such queries too.
class ContactAccumulator {
 public:
  /// Holds references: options and result must outlive it. Forgets what is in the result.
  ContactAccumulator(const QueryOptions& options, QueryResult& result);

  /// For a part of a search: begins with the bound and the limits that the whole has now. Holds a
  /// reference: the whole stays as it is until the part is over.
  ContactAccumulator(const ContactAccumulator& whole, QueryResult& result);
  ContactAccumulator(const ContactAccumulator&) = delete;
  ContactAccumulator& operator=(const ContactAccumulator&) = delete;

  /// The pairs of this search, or of this part, that count against the limit of pairs.
  std::uint64_t pairs_taken() const { return pairs_at_begin_ - pairs_left_; }
  std::uint64_t pairs_left() const { return pairs_left_; }
  bool lacks_pairs() const { return lacks_pairs_; }  ///< more came up than were left

  /// Goes on from where a part is over that has taken no more pairs than are left. Its contacts are
  /// kept apart from this, by keep().
  void absorb(const ContactAccumulator& part);

  const std::vector<Contact>& contacts() const { return result_.contacts; }

  /// [m] Pairs further apart than this do not matter any more.
  double bound() const { return bound_; }
  /// Whether contacts that are kept lower it.
  bool lowers_bound() const { return capacity_ != 0; }
  /// [m] The same, rounded up to single precision.
  float rounded_bound() const { return rounded_bound_; }

  /// The farthest of the k closest; nullptr until there are so many, and where all are kept.
  const Contact* farthest() const {
    return capacity_ != 0 && result_.contacts.size() == capacity_ ? &result_.contacts.front()
                                                                  : nullptr;
  }

  /// No further pair can change the answer: it is done.
  void stop() { done_ = true; }

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

  /// Counts the steps along a fibre that a pair has taken: many are as much work as other pairs.
  void count_loop_steps(std::uint64_t loop_steps) {
    pairs_left_ -= std::min(pairs_left_, loop_steps / QueryLimits::loop_steps_per_pair);
  }

  /// Keeps a contact that is within the bound, or notes that it does not.
  void keep(const Contact& contact);

  /// Notes that a pair is not reported whose gap is at least this [m].
  void leave_out(double lower);

  /// No further pair can change the answer, or none may: the deadline has passed, or the limit of
  /// pairs is reached. To be asked often.
  bool done() {
    if (limits_.deadline.is_set() && ++steps_ % steps_between_checks == 0) {
      check_deadline();
    }
    return done_;
  }
  /// done(), for callers that ask seldom: looks at the clock each time.
  bool done_by_now() {
    if (limits_.deadline.is_set()) {
      check_deadline();
    }
    return done_;
  }

  /// The order in which pairs are found matters for speed: near ones first. For FIBER_PAIRS it
  /// would save distances, but sorting costs more.
  bool wants_near_first() const { return capacity_ != 0; }

  /// Sorts the contacts; call once, at the end.
  /// @param min_gap [m] no pair at all has a smaller gap
  void finish(double min_gap);

 private:
  void keep_of_fibers(const Contact& contact);
  void keep_if_closest(const Contact& contact);
  void stay_within_limit();
  void set_bound(double bound);
  double slack(double distance) const;
  void check_deadline();
  void end_early();
  void reach_pair_limit();

  static constexpr std::uint32_t steps_between_checks = 32;  // looking takes as long as a few steps

  const QueryLimits limits_;
  const std::uint64_t pairs_at_begin_;
  std::uint64_t pairs_left_;
  bool lacks_pairs_ = false;
  FiberPairMinima minima_;  // FIBER_PAIRS only
  const QueryOptions& options_;
  QueryResult& result_;
  const std::size_t capacity_;  // of the k closest; 0 keeps all
  double bound_ = 0.0;          // [m]
  float rounded_bound_ = 0.0F;  // [m]
  bool done_ = false;
  std::uint32_t steps_ = 0;
};

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

  /// For a part of a search: collects into a result of its own, from the bounds that the whole has
  /// now. Parts of a whole may be looked for at the same time; the whole stays as it is until they
  /// are over.
  PairCollector(const PairCollector& whole, QueryResult& result);
  PairCollector(const PairCollector&) = delete;
  PairCollector& operator=(const PairCollector&) = delete;

  /// Goes on from where a part is over that has taken no more pairs than are left. What parts find,
  /// absorbed one after the other, does not depend on who has looked for them.
  void absorb(const PairCollector& part);

  /// The pairs of this search, or of this part, that count against the limit of pairs.
  std::uint64_t pairs_taken() const { return accumulator_.pairs_taken(); }
  std::uint64_t pairs_left() const { return accumulator_.pairs_left(); }
  bool lacks_pairs() const { return accumulator_.lacks_pairs(); }  ///< more came up than were left

  /// Whether one contact is enough.
  bool wants_any() const { return options_.type == QueryType::FIRST; }

  /// Considers the segments that start at these points: of the assembly in any order, or of the
  /// shape and of the fibres. Each pair may be offered once.
  void offer(std::uint32_t point_a, std::uint32_t point_b);

  /// [m] Pairs further apart than this do not matter any more; rounded up to single precision.
  float gap_bound() const { return accumulator_.rounded_bound(); }
  /// [m] The same as the bounding volumes of capsules take it: where those penetrate, volumes
  /// overlap, and know no negative margin.
  float bound() const { return std::max(gap_bound(), 0.0F); }

  /// Nor do pairs whose keys, as pair_bound.hpp has them, are not less than this: what is kept is
  /// as deep as any pair can be, and of equals the smallest indices win.
  std::uint64_t key_bound() const { return key_bound_; }

  bool wants_adjacent() const { return test_.wants_adjacent(); }
  PointRange ruled_out_with(std::uint32_t point) const { return test_.ruled_out_with(point); }

  /// See ContactAccumulator.
  bool done() { return accumulator_.done(); }
  bool done_by_now() { return accumulator_.done_by_now(); }
  bool wants_near_first() const { return accumulator_.wants_near_first(); }

  /// Sorts the contacts; call once, after the last offer.
  void finish();

 private:
  /// Finds the fibre of a point; at once if it is that of the point before.
  class FiberFinder {
   public:
    explicit FiberFinder(const FiberAssembly& fibers) : fibers_(fibers) {}
    std::uint32_t fiber_of(std::uint32_t point);
    std::uint32_t first_point_of(std::uint32_t fiber, std::uint32_t segment) const {
      return fibers_.offsets()[fiber] + segment;
    }

   private:
    const FiberAssembly& fibers_;
    std::uint32_t fiber_ = 0;
    std::uint32_t begin_ = 0;  // of its points; none yet
    std::uint32_t end_ = 0;
  };

  void offer_of_fibers(PointPair pair);
  std::optional<Contact> contact_within(PointPair pair, double bound);
  void look_at_depth();

  ContactAccumulator accumulator_;  // first: its time begins, and the test takes time to make
  const std::optional<NarrowPhase> own_test_;  // none in a part
  const NarrowPhase& test_;
  FiberFinder fibers_a_;
  FiberFinder fibers_b_;
  const QueryOptions& options_;
  QueryCounts& counts_;
  std::uint64_t key_bound_ = std::numeric_limits<std::uint64_t>::max();
};

}  // namespace fiber
