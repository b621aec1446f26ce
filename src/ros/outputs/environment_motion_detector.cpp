#include "src/ros/outputs/environment_motion_detector.hpp"

#include <map>
#include <string_view>
#include <utility>
#include <vector>

namespace fiber_proximity_ros {
namespace {

using fiber::Environment;
using fiber::EnvironmentObject;
using fiber::MotionContact;

/// The objects there are now where they were before; those that cannot have moved from there, where
/// they are.
std::shared_ptr<const Environment> as_before(const std::shared_ptr<const Environment>& before,
                                             const std::shared_ptr<const Environment>& now) {
  if (before == now) {
    return now;
  }
  std::map<std::string_view, const EnvironmentObject*> by_name;
  for (const EnvironmentObject& object : before->objects()) {
    by_name.emplace(object.name, &object);
  }
  std::vector<EnvironmentObject> objects = now->objects();
  for (EnvironmentObject& object : objects) {
    const auto found = by_name.find(object.name);
    if (found != by_name.end() && fiber::have_same_shapes(*found->second, object)) {
      object.pose = found->second->pose;
    }
  }
  return std::make_shared<const Environment>(std::move(objects));
}

}  // namespace

void EnvironmentMotionDetector::detect(const ContinuousStep& step,
                                       const std::shared_ptr<const Environment>& before,
                                       std::shared_ptr<const Environment> now,
                                       const fiber::QueryOptions& options,
                                       const fiber::AllowedPairs& allowed) {
  margin_ = options.margin;
  const fiber::FiberMotion& motion = step.motion;
  const fiber::MotionOptions asked = fiber::motion_options(options, step.tolerance);
  before_ = as_before(before, now);
  now_ = std::move(now);
  if (before_ == now_) {
    now_->query_motion(motion.before, motion.after, asked, allowed, result_);
  } else {
    before_->query_motion(motion.before, motion.after, *now_, asked, allowed, result_);
  }
}

KnownMotion EnvironmentMotionDetector::known_motion(const ContinuousStep& step,
                                                    bool reports_all) const {
  const auto first_contact = [this, &step](const MotionContact& contact) {
    return before_->first_contact(step.motion, *now_, contact);
  };
  // Nothing is known of when it parted but whether it has.
  const auto last_contacts = [this, &step](const std::vector<MotionContact>& contacts) {
    std::vector<fiber::LastContact> last;
    for (const MotionContact& contact : contacts) {
      const std::uint32_t point = step.motion.before.offsets()[contact.fiber_a] + contact.segment_a;
      const fiber::Contact at_end = now_->contact(fiber::capsule_at(step.motion, point, 1.0),
                                                  contact.fiber_b, contact.segment_b);
      last.push_back({fiber::time_of(contact), 1.0, at_end.distance <= margin_});
    }
    return last;
  };
  return {result_, first_contact, last_contacts, step.time, reports_all};
}

}  // namespace fiber_proximity_ros
