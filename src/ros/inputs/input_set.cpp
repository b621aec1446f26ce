#include "src/ros/inputs/input_set.hpp"

#include <malloc.h>
#include <ros/console.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/ros/inputs/input_source.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

InputSet::InputSet(ros::NodeHandle node, const std::vector<InputOptions>& inputs,
                   std::vector<Unknown> left_out, const InputTiming& timing,
                   const std::string& fixed_frame, const fiber::QueryOptions& answered,
                   std::function<void()> on_message)
    : frame_(fixed_frame, node),
      answered_(answered),
      on_message_(std::move(on_message)),
      left_out_(std::move(left_out)),
      last_time_(ros::Time::now()) {
  for (const InputOptions& options : inputs) {
    inputs_.push_back(std::make_unique<Input>(options, timing, worker_));
    can_be_uncertain_ = can_be_uncertain_ || timing.bounds_latency || options.uncertainty > 0.0;
    Input& input = *inputs_.back();
    const auto receiver = [this, &input](const ReceivedMessage& message) {
      receive(input, message);
    };
    if (!subscribes(options.where,
                    [&] { subscribers_.push_back(subscribe(node, options, receiver)); })) {
      left_out_.push_back({options.topic, "input " + options.topic, last_time_,
                           "its topic is subscribed to with another type already", true});
      inputs_.pop_back();
    }
  }
  if (timing.synchronize) {
    synchronizer_.emplace(inputs_.size(), timing, last_time_);
  }
}

bool InputSet::update() {
  const Stopwatch stopwatch;
  watch_time();
  bool changed = std::exchange(was_reset_, false);
  changed = accept_placed() || changed;
  bool leaves = false;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const bool is_unmatched = synchronizer_ && synchronizer_->is_unmatched(i);
    changed = inputs_[i]->expire(last_time_, is_unmatched) || changed;
    if (inputs_[i]->take_left_out()) {
      changed = true;
      leaves = true;
    }
  }
  if (leaves) {
    malloc_trim(0);  // what its fibres have taken is much
  }
  merged_is_old_ = merged_is_old_ || changed;
  if (can_be_uncertain_) {
    find_uncertainties();
  }
  if (!is_fresh()) {
    header_.frame_id = frame_.name();
    header_.stamp = last_time_;
  }
  work_time_ += stopwatch.seconds();
  return changed;
}

bool InputSet::is_waiting() const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [](const std::unique_ptr<Input>& input) { return input->is_waiting(); });
}

bool InputSet::is_fresh() const {
  return std::any_of(inputs_.begin(), inputs_.end(),
                     [](const std::unique_ptr<Input>& input) { return input->is_fresh(); });
}

void InputSet::doubt(double time) {
  for (const std::unique_ptr<Input>& input : inputs_) {
    input->doubt(time);
  }
}

std::string InputSet::topic_of_most(const std::vector<fiber::Contact>& contacts) const {
  std::vector<std::size_t> inputs;  // by fibre
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    inputs.resize(inputs.size() + (inputs_[i]->is_fresh() ? inputs_[i]->fibers().fiber_count() : 0),
                  i);
  }
  std::vector<std::size_t> counts(inputs_.size());
  for (const fiber::Contact& contact : contacts) {
    ++counts[inputs[contact.fiber_a]];
  }
  const auto most = std::max_element(counts.begin(), counts.end());
  return contacts.empty() ? "" : inputs_[most - counts.begin()]->options().topic;
}

std::vector<Unknown> InputSet::unknown() const {
  std::vector<Unknown> all = left_out_;
  for (const std::unique_ptr<Input>& input : inputs_) {
    if (std::optional<Unknown> unknown = input->unknown()) {
      all.push_back(std::move(*unknown));
    }
  }
  return all;
}

void InputSet::require_fresh() const {
  if (!is_fresh()) {
    throw std::invalid_argument("no fresh input: no fibres have arrived within the input_timeout");
  }
}

const std::shared_ptr<const FiberMessage>& InputSet::message() {
  if (std::exchange(merged_is_old_, false)) {
    merge();
  }
  return merged_.message();
}

void InputSet::receive(Input& input, const ReceivedMessage& message) {
  const Stopwatch stopwatch;
  watch_time();
  input.receive(message, frame_);
  work_time_ += stopwatch.seconds();
  on_message_();
}

void InputSet::watch_time() {
  const ros::Time now = ros::Time::now();
  if (now < last_time_) {
    ROS_WARN_STREAM("time went back from " << last_time_ << " to " << now
                                           << ": forgetting all fibres");
    was_reset_ = was_reset_ || is_fresh();
    for (const std::unique_ptr<Input>& input : inputs_) {
      input->reset();
    }
    if (synchronizer_) {
      synchronizer_->reset(now);
    }
  }
  last_time_ = now;
}

/// Has each input accept its placed messages: the newest, or those that belong together.
/// @returns true if that changed the fibres
bool InputSet::accept_placed() {
  bool changed = false;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    const std::vector<ros::Time> stamps = inputs_[i]->place_waiting(frame_, answered_);
    if (synchronizer_) {
      for (const ros::Time& stamp : stamps) {
        synchronizer_->add(i, stamp);
      }
    } else if (!stamps.empty()) {
      inputs_[i]->accept(stamps.back());
      changed = true;
    }
  }
  return synchronizer_ ? synchronizer_->accept(inputs_, last_time_) : changed;
}

void InputSet::merge() {
  const Stopwatch stopwatch;
  std::vector<FiberMessagePtr> fresh;
  for (const std::unique_ptr<Input>& input : inputs_) {
    if (input->is_fresh()) {
      fresh.push_back(input->message());
    }
  }
  merged_.merge(fresh);
  header_.frame_id = frame_.name();
  header_.stamp = fresh.empty() ? last_time_ : merged_.message()->stamp;
  work_time_ += stopwatch.seconds();
}

void InputSet::find_uncertainties() {
  uncertainties_.clear();
  bool is_any_uncertain = false;
  for (const std::unique_ptr<Input>& input : inputs_) {
    const std::size_t count = input->is_fresh() ? input->fibers().fiber_count() : 0;
    for (std::size_t fiber = 0; fiber < count; ++fiber) {
      uncertainties_.push_back(input->uncertainty(fiber, last_time_));
      is_any_uncertain = is_any_uncertain || uncertainties_.back() > 0.0;
    }
  }
  if (!is_any_uncertain) {
    uncertainties_.clear();
  }
}

}  // namespace fiber_proximity_ros
