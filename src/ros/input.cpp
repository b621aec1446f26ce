#include "fiber_proximity/ros/input.hpp"

#include <ros/console.h>

#include <stdexcept>
#include <utility>

namespace fiber_proximity_ros {

Input::Input(InputOptions options, const InputTiming& timing)
    : options_(std::move(options)), timing_(timing), refusals_(label()) {}

void Input::receive(const ReadMessage& read, FixedFrame& frame) {
  ++received_;
  try {
    store(read, frame);
  } catch (const std::invalid_argument& error) {
    refusals_.refuse(error.what());
  }
}

void Input::store(const ReadMessage& read, FixedFrame& frame) {
  if (!read(chains_)) {
    return;
  }
  std_msgs::Header& header = chains_.header;
  header.frame_id = tf2_name(header.frame_id);
  if (header.frame_id.empty()) {
    throw std::invalid_argument("header.frame_id is empty, it must name the frame of the points");
  }
  repeats_stamp_ = has_fibers_ && !header.stamp.isZero() && header.stamp == current_.header.stamp;
  if (repeats_stamp_) {
    return;  // a tracker that has frozen sends its last answer again and again
  }
  if (chains_.radii.empty()) {
    chains_.radii.assign(1, options_.radius);
  }
  assign(chains_, next_.fibers);
  overtake(next_);
  next_.full = true;
  next_.header = header;
  next_.arrival = ros::Time::now();
  next_.steady_arrival = ros::SteadyTime::now();
  next_.stamp = header.stamp.isZero() ? next_.arrival : header.stamp;
  name_fibers(next_);
  frame.adopt(header.frame_id);
}

bool Input::place_waiting(const FixedFrame& frame) {
  if (place(next_, frame)) {
    overtake(waiting_);
    accept(next_);
    return true;
  }
  if (place(waiting_, frame)) {
    accept(waiting_);
    return true;
  }
  const auto waited = [this] { return ros::SteadyTime::now() - waiting_.steady_arrival; };
  if (waiting_.full && waited().toSec() > timing_.tf_timeout) {
    waiting_.full = false;
    refusals_.refuse(transform_error_);
  }
  if (!waiting_.full) {
    std::swap(waiting_, next_);
  }
  return false;
}

bool Input::expire(const ros::Time& now) {
  if (!is_fresh() || (now - current_.arrival).toSec() <= timing_.input_timeout) {
    return false;
  }
  stale_ = true;
  ROS_WARN_STREAM(label() << ": no new message for " << timing_.input_timeout << " s"
                          << (repeats_stamp_ ? ", its messages repeat their stamp" : "") << "; its "
                          << fibers().fiber_count() << " fibre(s) are left out");
  return true;
}

void Input::reset() {
  next_.full = false;
  waiting_.full = false;
  has_fibers_ = false;
  stale_ = false;
  repeats_stamp_ = false;
}

fiber_proximity::InputStatistics Input::statistics(const ros::Time& now) const {
  fiber_proximity::InputStatistics statistics;
  statistics.topic = options_.topic;
  statistics.type = options_.type;
  statistics.received = received_;
  statistics.refused = refusals_.count();
  statistics.overtaken = overtaken_;
  statistics.fibers = is_fresh() ? static_cast<std::uint32_t>(fibers().fiber_count()) : 0;
  statistics.age = has_fibers_ ? (now - current_.arrival).toSec() : -1.0;
  statistics.stale = stale_;
  statistics.last_error = refusals_.last_error();
  return statistics;
}

/// @returns true if the message is now in the fixed frame
bool Input::place(Message& message, const FixedFrame& frame) {
  if (!message.full) {
    return false;
  }
  try {
    frame.place(message.header, message.fibers, buffer_);
    return true;
  } catch (const TransformUnavailable& error) {
    transform_error_ = error.what();
  } catch (const std::invalid_argument& error) {
    message.full = false;
    refusals_.refuse(error.what());
  }
  return false;
}

void Input::accept(Message& message) {
  std::swap(current_, message);
  message.full = false;
  has_fibers_ = true;
  if (stale_) {
    stale_ = false;
    ROS_INFO_STREAM(label() << ": new messages again");
  }
}

void Input::overtake(Message& message) {
  overtaken_ += message.full ? 1 : 0;
  message.full = false;
}

void Input::name_fibers(Message& message) const {
  if (!chains_.names.empty() || chains_.fiber_count() == 0) {
    message.names = chains_.names;
    return;
  }
  message.names.assign(chains_.fiber_count(), options_.name);
  for (std::size_t i = 0; message.names.size() > 1 && i < message.names.size(); ++i) {
    message.names[i] += "/" + std::to_string(i);
  }
}

std::string Input::label() const {
  return "input '" + options_.topic + "' (" + options_.type + ")";
}

}  // namespace fiber_proximity_ros
