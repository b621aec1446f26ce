#include "src/ros/outputs/environment_output.hpp"

#include <optional>
#include <utility>

#include "src/ros/outputs/contact_array.hpp"
#include "src/ros/outputs/fiber_step.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

EnvironmentOutput::EnvironmentOutput(const ros::NodeHandle& node, ros::NodeHandle private_node,
                                     InputSet& fibers, double tf_timeout,
                                     std::function<void()> on_message)
    : fibers_(fibers),
      inputs_(node, private_node, read_environment_options(node, private_node), fibers.frame(),
              tf_timeout, std::move(on_message)),
      environment_(inputs_.environment()),
      publisher_(private_node.advertise<fiber_proximity::ContactArray>("environment_contacts", 1)),
      touches_(fiber_proximity::Contact::OBJECT, advertise_contact_events(private_node)) {}

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
  environment_before_ = is_tracked_ ? environment_ : nullptr;
  environment_ = inputs_.environment();
  update_time_ += stopwatch.seconds();
  const fiber::AllowedPairs allowed = inputs_.allowed(fibers_.names());
  detection_.detect(options, wants_minimum,
                    [&](const fiber::QueryOptions& asked, fiber::QueryResult& result) {
                      environment_->query(fibers_.fibers(), asked, allowed, result);
                    });
  step_ = environment_before_ == nullptr || !has_listeners() ? nullptr : step;
  motion_time_ = 0.0;
  if (step_ != nullptr) {
    const Stopwatch motion_time;
    motion_.detect(*step_, environment_before_, environment_, options, allowed);
    motion_time_ = motion_time.seconds();
  }
}

void EnvironmentOutput::publish(const fiber::QueryOptions& options, bool has_gradients) {
  is_tracked_ = has_listeners();
  if (!is_tracked_) {
    skip();
    return;
  }
  const std_msgs::Header& header = fibers_.header();
  const std::chrono::nanoseconds now = to_time(header.stamp);
  std::optional<KnownMotion> motion;
  if (step_ != nullptr) {
    motion.emplace(motion_.known_motion(*step_, detection_.has_all_of(options)));
  }
  const BodyNames names{fibers_.names(), object_names(*environment_)};
  contacts_.assign(detection_.contacts().contacts, touches_.step_to(now),
                   motion ? &*motion : nullptr);
  touches_.track(contacts_.contacts(), names, header);
  if (publisher_.getNumSubscribers() == 0) {
    return;
  }
  to_message(detection_,
             {contacts_.contacts(), touches_, motion ? motion->time.lower : now, has_gradients},
             options, fiber_proximity::Contact::OBJECT, header, message_);
  message_.continuous = motion.has_value();
  if (motion) {
    message_.complete = message_.complete && motion->result.complete;
    message_.limit_reached = message_.limit_reached || motion->result.limit_reached;
  }
  message_.fiber_names = names.a;
  message_.object_names = names.b;
  message_.update_time = update_time_;
  publisher_.publish(message_);
}

void EnvironmentOutput::skip() {
  is_tracked_ = false;
  touches_.skip();
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
