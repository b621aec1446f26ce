#include "src/ros/outputs/motion_detector.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

using fiber::MotionContact;

void MotionDetector::detect(const FiberStep& step, const fiber::QueryOptions& options,
                            double tolerance) {
  const Stopwatch stopwatch;
  step_ = &step;
  options_ = fiber::motion_options(options, tolerance);
  const fiber::FiberMotion motion = step.motion();
  engine_->update_motion(motion.before, motion.after);
  engine_->query_motion(options_, result_);
  if (options.type == fiber::QueryType::FIBER_PAIRS) {
    keep_earliest_of_fiber_pairs();
  }
  time_ = stopwatch.seconds();
}

/// One contact for each pair of fibres, as the query has it.
void MotionDetector::keep_earliest_of_fiber_pairs() {
  std::map<std::pair<std::uint32_t, std::uint32_t>, MotionContact> earliest;
  for (const MotionContact& contact : result_.contacts) {
    MotionContact& first =
        earliest.try_emplace({contact.fiber_a, contact.fiber_b}, contact).first->second;
    if (contact.earlier_than(first)) {
      first = contact;
    }
  }
  result_.contacts.clear();
  for (const auto& [fibers, contact] : earliest) {
    result_.contacts.push_back(contact);
  }
}

KnownMotion MotionDetector::known_motion(bool reports_all) const {
  const fiber::FiberMotion motion = step_->motion();
  return {result_,
          [motion](const MotionContact& contact) {
            return fiber::first_contact(motion, motion, contact);
          },
          [motion, this](const std::vector<MotionContact>& contacts) {
            return fiber::last_contacts(motion, motion, contacts, options_);
          },
          step_->time(), reports_all};
}

}  // namespace fiber_proximity_ros
