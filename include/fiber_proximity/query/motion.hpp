#pragma once

#include <algorithm>
#include <cstdint>
#include <limits>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Which of the pairs that come into contact during a motion to report.
enum class MotionType {
  FIRST,    ///< the earliest one; of the same time, that of the smallest indices
  LIMITED,  ///< the max_contacts earliest ones
  ALL       ///< all of them, each with its first contact
};

/// Options for a motion from one state of the fibres to the next. Times are parts of it: 0
/// before, 1 after.
///
/// Whether a fibre makes a loop, and how long it is between two segments, is judged before the
/// motion. The contact_limit is for contacts that begin in the motion, and again for those that are
/// there before: where there are more, the earliest ones are reported, or those of the smallest
/// indices. Where more pairs come up than the pair_limit, none is reported. MotionResult has the
/// same flags as QueryResult.
struct MotionOptions : PairOptions {
  MotionType type = MotionType::ALL;

  /// [m] Pairs whose gap comes down to the margin and this may be reported, with
  /// MotionContact::certain false; finite, >= 0. Larger is faster. See contact_time().
  double tolerance = 1e-6;

  /// [1] Bounds on the time of a certain contact that are further apart than this part of the
  /// motion are brought nearer, as near as doubles allow; >= 0, infinity to leave them as the
  /// tolerance makes them. Smaller is slower, for contacts that come slowly.
  double time_tolerance = std::numeric_limits<double>::infinity();
};

/// @throws std::invalid_argument naming the field, its value and what is allowed
void validate(const MotionOptions& options);

/// Options of a query that asks for the same pairs, all of them.
QueryOptions pairs_of(const MotionOptions& options);

/// Options that ask for the same pairs over a motion: FIRST and CLOSEST for the earliest one,
/// LIMITED for as many, all others for all of them.
/// @param tolerance MotionOptions::tolerance [m]
MotionOptions motion_options(const QueryOptions& options, double tolerance);

/// Two segments, and when their gap first falls to the margin: a ContactTime with a hit.
template <class Index>
struct BasicMotionContact : BasicSegmentIdPair<Index> {
  double lower = 0.0;    ///< there is no contact before this
  double upper = 0.0;    ///< the gap is at most margin + tolerance at this time
  bool certain = false;  ///< the gap is at most the margin no later than `upper`

  bool earlier_than(const BasicMotionContact& other) const {
    return lower < other.lower || (lower == other.lower && this->key() < other.key());
  }
};
using MotionContact = BasicMotionContact<std::uint32_t>;

/// Answer to a query about a motion; kept by the caller and reused, so that its memory is.
struct MotionResult {
  /// Pairs whose contact begins during the motion, sorted by SegmentIdPair::key().
  std::vector<MotionContact> contacts;

  /// Pairs that are in contact before it already, decided exactly; at time 0, sorted alike. All of
  /// them, whatever the type.
  std::vector<MotionContact> touching;

  /// LIMITED reported max_contacts: there may be more. Or there were more contacts or pairs than
  /// the options allow.
  bool limit_reached = false;

  /// False: the deadline or the pair_limit came before all pairs had been ruled out.
  bool complete = true;

  /// No pair that was asked about and is not reported comes into contact before this;
  /// 1 if none does at all.
  double others_lower = 0.0;

  QueryCounts counts;

  /// The contact that begins first during the motion, nullptr if there is none.
  const MotionContact* earliest() const;

  /// Finds the same where only some pairs are asked about.
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

/// Fibres before and after a motion.
struct FiberMotion {
  const FiberAssembly& before;
  const FiberAssembly& after;

  /// Radius of the segment that starts at this point [m]: the larger one counts.
  double radius(std::uint32_t point) const {
    return std::max(before.segment_radius(point), after.segment_radius(point));
  }
};

/// A segment at a part of the motion, of the larger of its radii.
/// @param point its first one
Capsule capsule_at(const FiberMotion& motion, std::uint32_t point, double time);

/// The time at which a MotionContact is looked at: its `upper`, or `lower` where there is none.
double time_of(const MotionContact& contact);

/// The pair of a MotionContact as it is at time_of() it: distance, nearest points and normal as a
/// robust query about the fibres of that time has them.
/// @param a, b of the first and of the second segment, the same for fibres with each other
Contact first_contact(const FiberMotion& a, const FiberMotion& b, const MotionContact& contact);

/// When a pair is in contact for the last time, as parts of the motion.
struct LastContact {
  double lower = 0.0;  ///< the gap is at most margin + tolerance at this time
  double upper = 1.0;  ///< after this there is no contact
  bool lasts = true;   ///< they are in contact at the end of the motion, decided exactly
};

/// Looks at a motion from its end for pairs that come into contact in it.
/// @param options margin and tolerance count
/// @returns one for each contact
std::vector<LastContact> last_contacts(const FiberMotion& a, const FiberMotion& b,
                                       const std::vector<MotionContact>& contacts,
                                       const MotionOptions& options);

}  // namespace fiber
