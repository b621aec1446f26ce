#include "src/ros/inputs/input_set.hpp"

#include <malloc.h>
#include <ros/console.h>

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/ros/inputs/input_source.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {
namespace {

void append(const Input& input, FiberBuffer& merged) {
  const fiber::FiberAssembly& fibers = input.fibers();
  const auto begin = static_cast<std::uint32_t>(merged.points.size());
  merged.points.insert(merged.points.end(), fibers.points().begin(), fibers.points().end());
  for (std::size_t fiber = 1; fiber < fibers.offsets().size(); ++fiber) {
    merged.offsets.push_back(begin + fibers.offsets()[fiber]);
  }
  merged.names.insert(merged.names.end(), input.names().begin(), input.names().end());
  merged.header.stamp = std::max(merged.header.stamp, input.stamp());
}

bool has_radius_per_point(const fiber::FiberAssembly& fibers) {
  return fibers.radii().size() > 1 && fibers.radii().size() == fibers.point_count();
}

/// The radii of one input, written out per fibre or per point.
void append_radii(const fiber::FiberAssembly& fibers, bool per_point, std::vector<double>& radii) {
  if (per_point && has_radius_per_point(fibers)) {
    radii.insert(radii.end(), fibers.radii().begin(), fibers.radii().end());
    return;
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const double radius = fibers.radii()[fibers.radii().size() == 1 ? 0 : fiber];
    const std::size_t points = fibers.offsets()[fiber + 1] - fibers.offsets()[fiber];
    radii.insert(radii.end(), per_point ? points : 1, radius);
  }
}

/// The shortest form that holds the radii of all: one, one per fibre, or one per point.
void merge_radii(const std::vector<const Input*>& inputs, std::vector<double>& radii) {
  const auto& first = inputs.front()->fibers().radii();
  if (first.size() == 1 && std::all_of(inputs.begin(), inputs.end(), [&first](const Input* input) {
        return input->fibers().radii() == first;
      })) {
    radii = first;
    return;
  }
  const bool per_point = std::any_of(inputs.begin(), inputs.end(), [](const Input* input) {
    return has_radius_per_point(input->fibers());
  });
  for (const Input* input : inputs) {
    append_radii(input->fibers(), per_point, radii);
  }
}

}  // namespace

InputSet::InputSet(ros::NodeHandle node, const std::vector<InputOptions>& inputs,
                   std::vector<Unknown> left_out, const InputTiming& timing,
                   const std::string& fixed_frame, const fiber::QueryOptions& answered,
                   std::function<void()> on_message)
    : frame_(fixed_frame, node),
      answered_(answered),
      on_message_(std::move(on_message)),
      left_out_(std::move(left_out)),
      input_timeout_(timing.input_timeout),
      last_time_(ros::Time::now()) {
  for (const InputOptions& options : inputs) {
    inputs_.push_back(std::make_unique<Input>(options, timing, worker_));
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
    last_match_ = last_time_;
    matcher_.emplace(inputs_.size(), timing.synchronize_slop, timing.queue_size());
  }
}

bool InputSet::update() {
  const Stopwatch stopwatch;
  watch_time();
  bool changed = std::exchange(was_reset_, false);
  changed = (matcher_ ? accept_matches() : accept_placed()) || changed;
  bool leaves = false;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    changed = inputs_[i]->expire(last_time_, matcher_ && matcher_->is_stranger(i)) || changed;
    if (inputs_[i]->takes_leave()) {
      changed = true;
      leaves = true;
    }
  }
  if (leaves) {
    malloc_trim(0);  // what its fibres have taken is much
  }
  merged_is_old_ = merged_is_old_ || changed;
  if (!is_fresh()) {
    merged_.header.frame_id = frame_.name();
    merged_.header.stamp = last_time_;
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

const Input& InputSet::input_of(std::size_t fiber) const {
  for (const std::unique_ptr<Input>& input : inputs_) {
    const std::size_t count = input->is_fresh() ? input->fibers().fiber_count() : 0;
    if (fiber < count) {
      return *input;
    }
    fiber -= count;
  }
  throw std::out_of_range("there is no fibre of this index");
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

const fiber::FiberAssembly& InputSet::fibers() {
  if (std::exchange(merged_is_old_, false)) {
    merge();
  }
  return fibers_;
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
    if (matcher_) {
      matcher_->reset();
      last_match_ = now;
    }
  }
  last_time_ = now;
}

/// Takes what each input has, on its own.
/// @returns true if that changed the fibres
bool InputSet::accept_placed() {
  bool changed = false;
  for (const std::unique_ptr<Input>& input : inputs_) {
    const std::vector<ros::Time> stamps = input->place_waiting(frame_, answered_);
    if (!stamps.empty()) {
      input->accept(stamps.back());
      changed = true;
    }
  }
  return changed;
}

/// Takes what belongs together.
/// @returns true if that changed the fibres
bool InputSet::accept_matches() {
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    for (const ros::Time& stamp : inputs_[i]->place_waiting(frame_, answered_)) {
      matcher_->add(i, stamp);
    }
  }
  bool one_has_left = false;
  for (std::size_t i = 0; i < inputs_.size(); ++i) {
    if (inputs_[i]->is_silent(last_time_)) {
      one_has_left = matcher_->leave_out(i) || one_has_left;
    }
  }
  std::vector<StampSet> sets = matcher_->take();
  // Who waited for one that has left had no time to match yet.
  if (!sets.empty() || one_has_left || !matcher_->is_waiting()) {
    last_match_ = last_time_;
  } else if ((last_time_ - last_match_).toSec() > input_timeout_) {
    matcher_->leave_out_stranger(last_time_);
    sets = matcher_->take();
    last_match_ = last_time_;
  }
  for (const StampSet& set : sets) {
    for (std::size_t i = 0; i < inputs_.size(); ++i) {
      if (set[i]) {
        inputs_[i]->accept(*set[i]);
      }
    }
  }
  return !sets.empty();
}

void InputSet::merge() {
  const Stopwatch stopwatch;
  merged_.clear();
  merged_.header.frame_id = frame_.name();
  std::vector<const Input*> fresh;
  for (const std::unique_ptr<Input>& input : inputs_) {
    if (input->is_fresh()) {
      fresh.push_back(input.get());
      append(*input, merged_);
    }
  }
  if (fresh.empty()) {
    merged_.header.stamp = last_time_;
  } else {
    merge_radii(fresh, merged_.radii);
  }
  assign(merged_, fibers_);
  work_time_ += stopwatch.seconds();
}

}  // namespace fiber_proximity_ros
