#include "benchmark/kernels/decision_score.hpp"

namespace fiber {

MotionTruth::MotionTruth(const HardMotion& motion, double tolerance_in_metres)
    : tolerance(tolerance_in_metres) {
  const ContactTime claim = contact_time(motion.motions(), tolerance);
  const MotionScore judged = judge(motion, tolerance, claim);
  const bool is_proven = judged.without_upper + judged.false_alarms + judged.wrongly_certain == 0;
  contact = is_proven && claim.hit && claim.certain;
  near = is_proven && claim.hit;
  at_start = contact && claim.upper == 0.0;
  if (contact) {
    return;
  }
  const MotionScore never = judge(motion, tolerance, ContactTime());
  contact = never.misses > 0;
  undecided = !contact && never.undecided > 0;
  if (!contact && !near) {
    HardMotion thicker = motion;
    thicker.radius_a += tolerance;
    const MotionScore never_near = judge(thicker, tolerance, ContactTime());
    near = never_near.misses + never_near.undecided > 0;
    undecided = undecided || never_near.undecided > 0;
  }
  near = near || contact;
}

void DecisionScore::add(const HardMotion& motion, const MotionTruth& truth,
                        const Guarded<ContactTime>& guarded) {
  ended += guarded.outcome == Outcome::ENDED ? 1 : 0;
  no_answer +=
      guarded.outcome == Outcome::NO_ANSWER || guarded.outcome == Outcome::NOT_FINITE ? 1 : 0;
  if (guarded.outcome != Outcome::ANSWERED) {
    return;
  }
  ++answered;
  if (!guarded.answer.hit) {
    misses += truth.contact ? 1 : 0;
    start_misses += truth.at_start ? 1 : 0;
    return;
  }
  false_alarms += truth.near ? 0 : 1;
  const MotionScore score = judge(motion, truth.tolerance, guarded.answer);
  late += score.misses;
  early += score.false_alarms;
}

}  // namespace fiber
