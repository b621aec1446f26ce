#include "src/ros/outputs/environment_output.hpp"

#include <utility>

#include "fiber_proximity/Contact.h"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

EnvironmentOutput::EnvironmentOutput(const ros::NodeHandle& node, ros::NodeHandle private_node,
                                     InputSet& fibers, std::function<void()> on_message,
                                     const Newcomer& on_newcomer)
    : fibers_(fibers),
      inputs_(node, private_node, read_environment_options(node, private_node), fibers.frame(),
              std::move(on_message)),
      environment_(inputs_.environment()),
      contacts_(private_node, "environment_contacts", fiber_proximity::Contact::OBJECT,
                on_newcomer) {}

bool EnvironmentOutput::update() {
  fibers_.fibers();  // merged by now, and with them their stamp
  const Stopwatch stopwatch;
  const ros::Time stamp = fibers_.is_fresh() ? fibers_.header().stamp : ros::Time::now();
  const bool changed = inputs_.update(stamp);
  update_time_ = stopwatch.seconds();
  return changed;
}

void EnvironmentOutput::detect(const fiber::QueryOptions& options, bool wants_minimum,
                               const ContinuousStep* step) {
  const Stopwatch stopwatch;
  const auto before = is_tracked_ ? environment_ : nullptr;
  environment_ = inputs_.environment();
  update_time_ += stopwatch.seconds();
  const fiber::AllowedPairs allowed = inputs_.allowed(fibers_.names());
  detection_.detect(options, wants_minimum,
                    [&](const fiber::QueryOptions& asked, fiber::QueryResult& result) {
                      environment_->query(fibers_.fibers(), asked, allowed, result);
                    });
  motion_.reset();
  motion_time_ = 0.0;
  if (step != nullptr && before != nullptr && has_listeners()) {
    const Stopwatch motion_time;
    motion_.emplace(detect_motion_contacts({before, environment_}, allowed, *step, options,
                                           detection_.has_all_of(options), motion_result_));
    motion_time_ = motion_time.seconds();
  }
}

void EnvironmentOutput::publish(const fiber::QueryOptions& options, const Knowledge& knowledge,
                                bool has_gradients) {
  is_tracked_ = has_listeners();
  if (!is_tracked_) {
    skip();
    return;
  }
  const BodyNames names{fibers_.names(), object_names(*environment_)};
  Completeness known = knowledge.completeness(Knowledge::About::FIBERS_AND_ENVIRONMENT);
  known.add_cut_off(detection_.cut_off(options));
  if (motion_ && !motion_->result.complete) {
    known.add_cut_off(cut_off_text("pairs that move", options));
  }
  const ContactAnswer answer{detection_,      options,   motion_ ? &*motion_ : nullptr,
                             known,           knowledge, names,
                             fibers_.header()};
  contacts_.track(answer);
  contacts_.publish(answer, has_gradients, update_time_);
}

void EnvironmentOutput::skip() {
  is_tracked_ = false;
  contacts_.skip();
}

std::vector<std::string> object_names(const fiber::Environment& environment) {
  std::vector<std::string> names;
  names.reserve(environment.objects().size());
  for (const fiber::EnvironmentObject& object : environment.objects()) {
    names.push_back(object.name);
  }
  return names;
}

}  // namespace fiber_proximity_ros
