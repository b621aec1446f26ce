#pragma once

#include <chrono>
#include <cstdint>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "src/geometry/disjoint_sets.hpp"

namespace fiber {

/// A time that is known to be at least `lower` and at most `upper`; since any moment the caller
/// counts from.
struct TimeBounds {
  std::chrono::nanoseconds lower{};
  std::chrono::nanoseconds upper{};
};

/// Two segments that were in contact during a step from one state to the next.
struct TouchingPair : SegmentIdPair {
  double distance = 0.0;  ///< [m] their gap: at the end of the step, or when it was a contact
  bool is_gone = false;   ///< they are no longer in contact at the end of the step
  TimeBounds first;       ///< when, during the step, they first were
  TimeBounds last;        ///< if they are gone: when they were for the last time
};

/// One place where two fibres touch, from its beginning to its end: all pairs in contact that are
/// neighbours of each other, their segments the same or next to each other on both fibres, across
/// the seam of a closed one as well. As a contact slides along, its pairs change and the touch
/// stays.
struct Touch {
  std::uint64_t id = 0;  ///< never 0
  TimeBounds began;
  double deepest = 0.0;  ///< [m] the smallest gap that was seen
  TouchingPair pair;     ///< the one of that gap in the last step
};

/// Where fibres are closed.
struct TouchSeams {
  /// By fibre the last segment of one that is closed, 0 of an open one; empty: all are open.
  std::vector<std::uint32_t> last_segments;
  bool are_of_both = false;  ///< the second bodies are these fibres, too, not objects
};

/// Pairs that follow each other, of one segment a with consecutive segments b: they hang together.
struct TouchRun {
  std::uint64_t a;        ///< the segment, as one number in the order of fibre and index
  std::uint64_t first_b;  ///< the first segment b, as such a number
  std::uint64_t last_b;   ///< the last one
  std::uint32_t begin;    ///< of its pairs
  std::uint32_t end;      ///< after its last one
  std::uint64_t kind;     ///< the same of all its pairs

  static std::uint64_t number_of(std::uint32_t fiber, std::uint32_t segment) {
    return std::uint64_t{fiber} << 32 | segment;
  }
  static std::uint32_t fiber_of(std::uint64_t number) {
    return static_cast<std::uint32_t>(number >> 32);
  }
  static std::uint32_t segment_of(std::uint64_t number) {
    return static_cast<std::uint32_t>(number);
  }
};

/// That a touch began or ended.
struct TouchEvent {
  enum class Kind { BEGAN, ENDED };
  Kind kind = Kind::BEGAN;
  Touch touch;
  TimeBounds time;

  /// The longest that the touch can have lasted so far.
  std::chrono::nanoseconds duration() const { return time.upper - touch.began.lower; }
};

/// Recognises contacts from step to step.
///
/// A touch is one patch of neighbouring pairs at the end of a step. Pairs that touched during the
/// step and are gone belong to the patch that they were next to. A touch goes on in a patch that
/// has one of its pairs of the step before or, if none has, in one with a pair next to these. Where
/// touches meet, the oldest one goes on and the others end; where one parts, it goes on in the
/// patch of the smallest indices, and the other patches begin: when they part, or where none of
/// their pairs was in contact before, when the first of these came.
class FIBER_PROXIMITY_EXPORT TouchTracker {
 public:
  /// @param first_id, id_step ids are first_id, first_id + id_step, …: two trackers need not give
  ///        the same
  explicit TouchTracker(std::uint64_t first_id = 1, std::uint64_t id_step = 1)
      : next_id_(first_id), id_step_(id_step) {}

  /// Which fibres of the steps from now on are closed; none are to begin with.
  void set_seams(TouchSeams seams) { seams_ = std::move(seams); }

  /// Takes a step.
  /// @param pairs  of the step, sorted by key; the same segments may be there more than once
  /// @param step   from the state before to the one after
  /// @param events what began, then what ended, is appended
  void advance(const std::vector<TouchingPair>& pairs, const TimeBounds& step,
               std::vector<TouchEvent>& events);

  /// The touch that a pair of the last step belongs to.
  const Touch& touch_of(std::size_t pair) const { return touches_[touch_of_pair_[pair]].touch; }

  /// New indices of fibres by old one; of those that are no more, none.
  using FiberIndices = std::vector<std::optional<std::uint32_t>>;

  /// The fibres of one assembly have other indices from now on. Touches of those that are no more
  /// end.
  /// @param step from the last state to that in which they are no more
  void renumber(const FiberIndices& indices, const TimeBounds& step,
                std::vector<TouchEvent>& events);
  /// Renumbers where first and second bodies are of two kinds.
  void renumber(const FiberIndices& indices_a, const FiberIndices& indices_b,
                const TimeBounds& step, std::vector<TouchEvent>& events);

  /// Forgets all touches, which do not end by that.
  void forget();

 private:
  /// A touch in the step that was taken last.
  struct TouchStep {
    Touch touch;
    bool is_new;
    bool lasts;       // has a pair that is not gone
    TimeBounds last;  // when its pairs that are gone were in contact for the last time
    bool was_there;   // has a pair that was in contact before the step, and is
    TimeBounds left;  // when its pairs came that were there and are gone: parts of another touch,
                      // if it has others
  };

  /// A pair at the end of that step.
  struct Standing : SegmentIdPair {
    std::uint32_t touch;
  };

  void find_patches(const std::vector<TouchingPair>& pairs);
  bool find_parts(const std::vector<TouchingPair>& pairs);
  void share_gone_pairs(const std::vector<TouchingPair>& pairs);
  void find_claims(const std::vector<TouchingPair>& pairs);
  void end_unclaimed(const TimeBounds& step, std::vector<TouchEvent>& events);
  void go_on();
  void begin_others(std::size_t pair_count);
  static void take(const TouchingPair& pair, const TimeBounds& step, TouchStep& taken);
  void begin_when_parted(std::size_t pair_count);

  std::uint64_t next_id_;
  std::uint64_t id_step_;
  TouchSeams seams_;
  std::vector<TouchStep> touches_;            // of the last step, by id
  std::vector<std::uint32_t> touch_of_pair_;  // of the last step
  std::vector<Standing> standing_;            // sorted by key

  /// A patch that a touch of the step before may go on in.
  struct Claim {
    std::uint32_t touch;
    bool is_next_to;  // by a pair next to one of its own, not by one that stays
    std::uint32_t patch;

    auto key() const { return std::tie(touch, is_next_to, patch); }
  };

  // These are of the step being taken; members for their memory. A patch is known by its first
  // pair.
  std::vector<std::uint32_t> patches_;  // by pair: the first pair of its patch
  std::vector<std::uint32_t> parts_;    // the same, of what is there at the end of the step
  std::vector<TouchRun> runs_;          // each of one patch, there or gone at the end of the step
  std::vector<TouchRun> other_runs_;
  DisjointSets joined_;               // runs that are neighbours
  std::vector<std::uint32_t> roots_;  // by run: the first that it is joined with

  /// The outcome of a patch.
  struct Parting {
    std::uint32_t first_part;
    bool has_parted;
    TimeBounds time;  // of that
  };
  std::vector<Parting> partings_;  // by patch
  std::vector<std::uint32_t> touch_of_patch_;
  std::vector<Claim> claims_;
  std::vector<std::uint32_t>
      claimed_last_;  // by touch: the patches of its last claims of both kinds
  std::vector<TouchStep> last_touches_;
};

}  // namespace fiber
