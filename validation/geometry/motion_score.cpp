#include "validation/geometry/motion_score.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "validation/geometry/motion_oracle.hpp"

namespace fiber {

MotionScore& MotionScore::operator+=(const MotionScore& more) {
  motions += more.motions;
  hits += more.hits;
  certain += more.certain;
  without_upper += more.without_upper;
  misses += more.misses;
  false_alarms += more.false_alarms;
  wrongly_certain += more.wrongly_certain;
  wide += more.wide;
  undecided += more.undecided;
  return *this;
}

double extent_of(const HardMotion& motion) {
  double extent = 0.0;
  for (const auto& [a, b] : {std::pair(motion.a_before.data(), motion.b_before.data()),
                             std::pair(motion.a_after.data(), motion.b_after.data())}) {
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        extent = std::max(extent, (a[i] - b[j]).cwiseAbs().maxCoeff());
      }
    }
  }
  return extent;
}

MotionScore judge(const HardMotion& motion, double tolerance, const ContactTime& answer) {
  using Verdict = MotionOracle::Verdict;
  const MotionOracle truth(motion);
  MotionScore score;
  score.motions = 1;
  const Verdict before = truth.contact_before(answer.hit ? answer.lower : 1.0);
  const bool ends_in_contact = !answer.hit && truth.is_within(1.0, 0.0);
  score.misses = before == Verdict::CONTACT || ends_in_contact ? 1 : 0;
  score.undecided = before == Verdict::UNDECIDED ? 1 : 0;
  if (!answer.hit) {
    return score;
  }
  score.hits = 1;
  score.certain = answer.certain ? 1 : 0;
  if (std::isinf(answer.upper)) {
    score.without_upper = 1;
    score.wrongly_certain = answer.certain ? 1 : 0;
    return score;
  }
  score.false_alarms = truth.is_within(answer.upper, tolerance) ? 0 : 1;
  if (answer.certain && !truth.is_within(answer.upper, 0.0)) {
    const Verdict crosses =
        truth.limit() > 0.0 ? Verdict::NONE : truth.crosses_between(answer.lower, answer.upper);
    score.wrongly_certain = crosses == Verdict::CONTACT ? 0 : 1;
  }
  const long double speed = truth.fastest();
  if (10.0L * truth.closing(answer.lower) >= speed) {
    // Times are rounded to doubles.
    score.wide = (answer.upper - answer.lower) * speed > 20.0L * tolerance + 0x1p-44L * speed;
  }
  return score;
}

}  // namespace fiber
