#pragma once

#include <cstdint>

#include "benchmark/kernels/guarded.hpp"
#include "validation/geometry/motion_score.hpp"

namespace fiber {

/// The truth about a motion, found by judge(), which looks first where contact_time() claims that
/// there is a contact.
struct MotionTruth {
  MotionTruth(const HardMotion& motion, double tolerance);

  double tolerance;        ///< [m]
  bool contact = false;    ///< the capsules surely touch
  bool at_start = false;   ///< they do at the beginning
  bool near = false;       ///< they may come within the tolerance of it
  bool undecided = false;  ///< one of these could not be found out
};

/// How right a kernel's decisions and times are, whatever it promises.
struct DecisionScore {
  std::uint64_t answered = 0;
  std::uint64_t misses = 0;        ///< contacts without a hit
  std::uint64_t start_misses = 0;  ///< those of them at the beginning
  std::uint64_t false_alarms = 0;  ///< hits of capsules that do not come within the tolerance
  std::uint64_t late = 0;          ///< hits with a contact before `lower`
  std::uint64_t early = 0;         ///< hits with a gap of more than the tolerance at `upper`
  std::uint64_t no_answer = 0;     ///< an exception, or a time that is none
  std::uint64_t ended = 0;         ///< ends of the process, and seconds without an answer

  void add(const HardMotion& motion, const MotionTruth& truth, const Guarded<ContactTime>& guarded);
};

}  // namespace fiber
