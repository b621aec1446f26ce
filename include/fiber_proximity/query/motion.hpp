#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <tuple>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// Which of the pairs that come into contact during a motion to report.
enum class MotionType {
  FIRST,    ///< the earliest one; of the same time, that of the smallest indices
  LIMITED,  ///< the max_contacts earliest ones
  ALL       ///< all of them, each with its first contact
};

/// What to ask about a motion from one state of the fibres to the next. Times are parts of it: 0
/// before, 1 after.
struct MotionOptions {
  MotionType type = MotionType::ALL;

  /// [m] Pairs with a gap of at most this are in contact; >= 0, infinity for no limit.
  double margin = 0.0;

  /// [m] Pairs whose gap comes down to the margin and this may be reported, with
  /// MotionContact::certain false; finite, >= 0. Larger is faster. See contact_time().
  double tolerance = 1e-6;

  /// [1] Bounds on the time of a certain contact that are further apart than this part of the
  /// motion are brought nearer, as near as doubles allow; >= 0, infinity to leave them as the
  /// tolerance makes them. Smaller is slower, for contacts that come slowly.
  double time_tolerance = std::numeric_limits<double>::infinity();

  /// LIMITED only: the most contacts to report, at least 1.
  std::uint32_t max_contacts = 100;

  /// Which pairs of the fibres with each other count, as of QueryOptions. Whether a fibre makes a
  /// loop, and how long it is between two segments, is judged before the motion.
  Pairing pairing = Pairing::ALL;
  std::optional<std::uint32_t> neighbour_skip;
  std::optional<double> neighbour_skip_length;

  /// [s] As of QueryOptions; 0 for none.
  double deadline = 0.0;

  /// The most contacts to report that begin in the motion, and as many that are there before; 0 for
  /// no limit. Where there are more, the earliest ones are reported, or those of the smallest
  /// indices, and MotionResult::limit_reached is set.
  std::uint32_t contact_limit = 0;

  /// The most pairs of segments to examine, 0 for no limit: where more come up, none is reported,
  /// MotionResult::complete is false, and limit_reached set.
  std::uint64_t pair_limit = 0;
};

/// @throws std::invalid_argument naming the field, its value and what is allowed
void validate(const MotionOptions& options);

/// Options of a query that asks for the same pairs, all of them.
QueryOptions pairs_of(const MotionOptions& options);

/// Options that ask for the same pairs over a motion: FIRST and CLOSEST for the earliest one,
/// LIMITED for as many, all others for all of them.
/// @param tolerance MotionOptions::tolerance [m]
MotionOptions motion_options(const QueryOptions& options, double tolerance);

/// Two segments, by fibre and index along it, and when their gap first falls to the margin: a
/// ContactTime with a hit.
struct MotionContact {
  std::uint32_t fiber_a = 0;
  std::uint32_t segment_a = 0;
  std::uint32_t fiber_b = 0;
  std::uint32_t segment_b = 0;
  double lower = 0.0;    ///< there is no contact before this
  double upper = 0.0;    ///< the gap is at most margin + tolerance at this time
  bool certain = false;  ///< the gap is at most the margin no later than `upper`

  /// What contacts are sorted by.
  auto key() const { return std::tie(fiber_a, segment_a, fiber_b, segment_b); }

  bool earlier_than(const MotionContact& other) const {
    return lower < other.lower || (lower == other.lower && key() < other.key());
  }
};

/// Answer to a query about a motion; kept by the caller and reused, so that its memory is.
struct MotionResult {
  /// Pairs whose contact begins during the motion, sorted by MotionContact::key().
  std::vector<MotionContact> contacts;

  /// Pairs that are in contact before it already, decided exactly; at time 0, sorted alike. All of
  /// them, whatever the type.
  std::vector<MotionContact> touching;

  /// LIMITED reported max_contacts: there may be more. Or there were more contacts or pairs than
  /// the options allow.
  bool limit_reached = false;

  /// False: the deadline or the pair_limit came before all pairs had been ruled out.
  bool complete = true;

  /// Of the pairs that were asked about, none that is not reported comes into contact before this;
  /// 1 if none does at all.
  double others_lower = 0.0;

  QueryCounts counts;

  /// The contact that begins first during the motion, nullptr if there is none.
  const MotionContact* earliest() const;

  /// The same of those that this holds for.
  template <class IsAsked>
  const MotionContact* earliest(const IsAsked& is_asked) const {
    const MotionContact* first = nullptr;
    for (const MotionContact& contact : contacts) {
      if (is_asked(contact) && (first == nullptr || contact.earlier_than(*first))) {
        first = &contact;
      }
    }
    return first;
  }
};

}  // namespace fiber
