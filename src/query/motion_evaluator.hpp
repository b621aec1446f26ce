#pragma once

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/contact_time.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {

/// Candidates that one thread looks at at a time.
constexpr std::size_t motions_per_slice = 512;

/// Results of one thread for the candidates it takes at a time.
struct MotionSlice {
  std::vector<MotionContact> contacts;
  std::vector<MotionContact> touching;
  bool complete = true;
};

/// Pairs that may come into contact during a motion.
struct MotionCandidates {
  std::vector<std::uint64_t> keys;  ///< see pair_key(); in ascending order
  bool are_all = true;              ///< false: the deadline has passed
  bool are_too_many = false;        ///< more than may be examined: there are none
  QueryCounts counts;
};

/// The most contacts to report that begin during the motion, 0 for no limit.
FIBER_PROXIMITY_EXPORT std::size_t max_reported(const MotionOptions& options);

/// Puts together what was found of the candidates, slice by slice, and leaves what the options ask
/// for.
/// @param result its lists must be empty
FIBER_PROXIMITY_EXPORT void merge_slices(const MotionSlice* slices, std::size_t count,
                                         const MotionCandidates& candidates,
                                         const MotionOptions& options, MotionResult& result);

/// How two segments move, for contacts within the margin [m].
inline SegmentMotions motions_of(const FiberMotion& a, const FiberMotion& b, PointPair pair,
                                 double margin) {
  return {&a.before.points()[pair.a],
          &a.after.points()[pair.a],
          &b.before.points()[pair.b],
          &b.after.points()[pair.b],
          {a.radius(pair.a), b.radius(pair.b), margin}};
}

/// Whether two segments are in contact before the motion already.
inline bool is_there_before(const ContactTime& time) { return time.certain && time.upper == 0.0; }

/// Brings the bounds of a certain contact nearer to each other, to MotionOptions::time_tolerance,
/// by asking again with smaller and smaller tolerances: what is proven with any of them holds.
/// @param ask for the pair's ContactTime with a tolerance [m]
template <class Ask>
void narrow(ContactTime& time, const MotionOptions& options, const Ask& ask) {
  constexpr int max_questions = 6;
  constexpr double factor = 0x1p-8;
  double tolerance = factor * options.tolerance;
  for (int i = 0; i < max_questions && time.certain && tolerance > 0.0 &&
                  time.upper - time.lower > options.time_tolerance;
       ++i, tolerance *= factor) {
    const ContactTime again = ask(tolerance);
    if (again.hit) {
      time.lower = std::max(time.lower, again.lower);
    }
    if (again.hit && again.certain) {
      time.upper = std::min(time.upper, again.upper);
    }
  }
}

/// Finds when candidates come into contact, slice by slice on several threads. Gives the same for
/// any number of threads. Keeps its memory from query to query.
class MotionEvaluator {
 public:
  /// @param a, b of the first and the second segments of pairs, the same for fibres with each other
  /// @param test of the fibres before the motion
  /// @param result its lists must be empty
  void evaluate(const MotionCandidates& candidates, const FiberMotion& a, const FiberMotion& b,
                const NarrowPhase& test, const MotionOptions& options, const QueryLimits& limits,
                MotionResult& result);

 private:
  std::vector<ContactTime> times_;  // of a round
  std::vector<MotionSlice> slices_;
};

}  // namespace fiber
