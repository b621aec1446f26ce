#include "src/ros/inputs/input.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cassert>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "src/ros/support/stamps.hpp"

namespace fiber_proximity_ros {
namespace {

/// By the input, where the message does not; before any are left out or cut, so that the others
/// keep their names.
void name_fibers(const std::string& input, FiberBuffer& chains) {
  if (!chains.names.empty()) {
    return;
  }
  chains.names.assign(chains.fiber_count(), input);
  for (std::size_t i = 0; chains.names.size() > 1 && i < chains.names.size(); ++i) {
    chains.names[i] += "/" + std::to_string(i);
  }
}

}  // namespace

Input::Input(InputOptions options, const InputTiming& timing, Worker& worker)
    : options_(std::move(options)),
      timing_(timing),
      log_(options_.topic, options_.type, "input "),
      budget_(options_.cost),
      worker_(worker) {}

void Input::receive(const ReceivedMessage& message, FixedFrame& frame) {
  log_.receive();
  if (message.sequence) {
    gaps_.add(message.publisher, *message.sequence);
  }
  if (budget_.is_closed()) {
    log_.refuse(budget_.problem());
    return;
  }
  try {
    if (store(message.read, frame)) {
      message.keep();
    }
  } catch (const std::invalid_argument& error) {
    log_.refuse(error.what());
  }
}

/// @returns whether the message counts: not if it holds nothing for this input, or nothing new
bool Input::store(const ReadMessage& read, FixedFrame& frame) {
  const ReadResult result = read(chains_);
  if (!result.is_for_input) {
    return false;
  }
  std_msgs::Header header = chains_.header;
  header.frame_id = tf2_name(header.frame_id);
  if (header.frame_id.empty()) {
    throw std::invalid_argument("header.frame_id is empty, it must name the frame of the points");
  }
  const ros::Time now = ros::Time::now();
  const ros::Time stamp = header.stamp.isZero() ? now : header.stamp;
  check_stamp(stamp, now);
  repeats_stamp_ =
      !header.stamp.isZero() && header.stamp == newest_header_stamp_ && !result.is_news;
  if (repeats_stamp_) {
    return false;  // a tracker that has frozen sends its last answer again and again
  }
  name_fibers(options_.name, chains_);
  const std::uint64_t gaps_before = missing_.gaps;
  handle_missing_points(options_.missing_points, chains_, missing_);
  if (chains_.radii.empty()) {
    chains_.radii.assign(1, options_.radius);
  }
  MessagePtr message = spares_.take();
  assign(chains_, message->fibers);
  message->names.swap(chains_.names);
  message->missing = result.missing;
  if (const std::uint64_t gaps = missing_.gaps - gaps_before; gaps > 0) {
    message->missing +=
        (result.missing.empty() ? "" : ", ") + std::to_string(gaps) + " of its points are missing";
  }
  message->header = header;
  message->stamp = stamp;
  message->arrival = now;
  message->steady_arrival = ros::SteadyTime::now();
  last_stamp_ = stamp;
  last_arrival_ = now;
  frame.adopt(header.frame_id);
  if (waiting_.size() == timing_.queue_size()) {
    overtake(waiting_.back());
    waiting_.pop_back();
  }
  waiting_.push_back(std::move(message));
  for (const std::string& remark : result.remarks) {
    log_.remark(remark);
  }
  return true;
}

/// A recording starts again at its end.
void Input::check_stamp(const ros::Time& stamp, const ros::Time& now) const {
  validate_stamp(stamp, now, timing_.max_stamp_ahead);
  const bool starts_anew = !last_arrival_ || (now - *last_arrival_).toSec() > timing_.input_timeout;
  if (!starts_anew && stamp < *last_stamp_) {
    std::ostringstream error;
    error << "its stamp " << stamp << " is older than " << *last_stamp_
          << ", that of the message before it";
    throw std::invalid_argument(error.str());
  }
}

std::vector<ros::Time> Input::place_waiting(const FixedFrame& frame,
                                            const fiber::QueryOptions& answered) {
  for (; placed_.size() > timing_.queue_size(); placed_.pop_front()) {
    overtake(placed_.front());
  }
  if (trial_ && !trial_->cost.is_ready()) {
    return {};
  }
  std::vector<MessagePtr> placed;
  if (trial_) {
    placed.push_back(end_trial());
  } else {
    placed = place_all(frame);
  }
  std::vector<ros::Time> stamps;
  for (MessagePtr& message : placed) {
    if (message != nullptr && trial_) {
      overtake(message);  // the one before it has its turn
    } else if (message != nullptr && budget_.is_to_be_tried(message->fibers)) {
      begin_trial(std::move(message), answered);
    } else if (message != nullptr) {
      stamps.push_back(message->stamp);
      newest_header_stamp_ = message->header.stamp;
      newest_arrival_ = message->arrival;
      placed_.push_back(std::move(message));
    }
  }
  return stamps;
}

/// Brings what waits into the fixed frame.
/// @returns those that are, in their order
std::vector<Input::MessagePtr> Input::place_all(const FixedFrame& frame) {
  // From the newest to the oldest: what comes before one that is placed has lost its turn, unless
  // it can be placed, too, and may be the one that those of the other inputs belong to.
  std::vector<MessagePtr> placed;
  for (auto message = waiting_.rbegin(); message != waiting_.rend(); ++message) {
    if ((placed.empty() || timing_.synchronize) && place(*message, frame)) {
      placed.push_back(std::move(*message));
    } else if (!placed.empty() && *message != nullptr) {
      overtake(*message);
    }
  }
  waiting_.erase(std::remove(waiting_.begin(), waiting_.end(), nullptr), waiting_.end());
  const auto waited = [this] {
    return (ros::SteadyTime::now() - waiting_.front()->steady_arrival).toSec();
  };
  if (!waiting_.empty() && waited() > timing_.tf_timeout) {
    spares_.add(waiting_.front());
    waiting_.pop_front();
    log_.refuse(transform_error_);
  }
  std::reverse(placed.begin(), placed.end());
  return placed;
}

void Input::begin_trial(MessagePtr message, const fiber::QueryOptions& answered) {
  auto find_cost = [message, answered, limits = budget_.limits()] {
    return cost_of(message->fibers, answered, limits);
  };
  trial_.emplace(Trial{std::move(message), Prepared<FiberCost>(std::move(find_cost), &worker_)});
}

/// @returns the message that was tried, or null if it costs too much
Input::MessagePtr Input::end_trial() {
  Trial trial = std::move(*std::exchange(trial_, std::nullopt));
  budget_.take(trial.message->fibers, trial.cost.get());
  if (budget_.problem().empty()) {
    return std::move(trial.message);
  }
  log_.refuse(budget_.problem());
  trial.message.reset();
  leave_out();
  return nullptr;
}

/// Gives back what its fibres have taken.
void Input::leave_out() {
  takes_leave_ = true;
  has_fibers_ = false;
  waiting_.clear();
  placed_.clear();
  current_ = std::make_shared<Message>();
  spares_ = {};
  chains_ = {};
  std::vector<Eigen::Vector3d>().swap(buffer_);
}

void Input::accept(const ros::Time& stamp) {
  for (; placed_.front()->stamp < stamp; placed_.pop_front()) {
    overtake(placed_.front());
    assert(placed_.size() > 1);
  }
  assert(placed_.front()->stamp == stamp);
  spares_.add(current_);
  current_ = std::move(placed_.front());
  placed_.pop_front();
  has_fibers_ = true;
  log_.accept();
  if (staleness_ != Staleness::NONE) {
    staleness_ = Staleness::NONE;
    stale_reason_.clear();
    ROS_INFO_STREAM(log_.label() << ": new messages again");
  }
}

bool Input::is_silent(const ros::Time& now) const {
  return !newest_arrival_ || (now - *newest_arrival_).toSec() > timing_.input_timeout;
}

bool Input::expire(const ros::Time& now, bool is_stranger) {
  const bool has_stopped = newest_arrival_ && is_silent(now);
  const Staleness staleness = has_stopped   ? Staleness::SILENT
                              : is_stranger ? Staleness::STRANGER
                                            : Staleness::NONE;
  if (staleness == Staleness::NONE || staleness == staleness_) {
    return false;
  }
  const bool was_fresh = is_fresh();
  std::ostringstream reason;
  if (has_stopped) {
    reason << "no new message for " << timing_.input_timeout << " s"
           << (repeats_stamp_ ? ", its messages repeat their stamp" : "");
    if (!log_.refused_since().empty()) {
      reason << ", its last one was refused: " << log_.refused_since();
    }
    for (; !placed_.empty(); placed_.pop_front()) {
      overtake(placed_.front());
    }
  } else {
    reason << "no stamp within " << timing_.synchronize_slop
           << " s (synchronize_slop) of those of the other inputs for " << timing_.input_timeout
           << " s, the newest is " << *last_stamp_;
  }
  staleness_ = staleness;
  stale_reason_ = reason.str();
  ROS_WARN_STREAM(log_.label() << ": " << stale_reason_ << "; its " << fibers().fiber_count()
                               << " fibre(s) are left out");
  return was_fresh;
}

void Input::reset() {
  waiting_.clear();
  trial_.reset();
  placed_.clear();
  has_fibers_ = false;
  staleness_ = Staleness::NONE;
  stale_reason_.clear();
  repeats_stamp_ = false;
  last_stamp_.reset();
  last_arrival_.reset();
  newest_header_stamp_.reset();
  newest_arrival_.reset();
  beginning_ = ros::Time::now();
}

std::optional<Unknown> Input::unknown() const {
  const std::string& topic = options_.topic;
  if (is_fresh()) {
    return current_->missing.empty()
               ? std::nullopt
               : std::make_optional<Unknown>(
                     {topic, "input " + topic, current_->stamp, current_->missing, true});
  }
  if (!budget_.problem().empty()) {
    return Unknown{topic, "input " + topic, budget_.since(), budget_.problem(), true};
  }
  if (!options_.required) {
    return std::nullopt;
  }
  const bool is_stale = staleness_ != Staleness::NONE;
  return Unknown{topic, "input " + topic, newest_arrival_.value_or(beginning_),
                 is_stale ? stale_reason_ : absence(), is_stale};
}

/// Why there have been no fibres yet.
std::string Input::absence() const {
  const std::string reason =
      newest_arrival_ ? "no message that belongs to those of other inputs yet" : "no message yet";
  const std::string& refused = log_.refused_since();
  return refused.empty() ? reason : reason + " but what was refused: " + refused;
}

fiber_proximity::InputStatistics Input::statistics(const ros::Time& now) const {
  fiber_proximity::InputStatistics statistics = log_.statistics();
  statistics.dropped = gaps_.count();
  statistics.missing_points = missing_.points;
  statistics.missing_fibers = missing_.fibers;
  statistics.lone_points = missing_.lone_points;
  statistics.fibers = is_fresh() ? static_cast<std::uint32_t>(fibers().fiber_count()) : 0;
  statistics.age = has_fibers_ ? (now - current_->arrival).toSec() : -1.0;
  statistics.stale = staleness_ != Staleness::NONE;
  return statistics;
}

/// @returns true if the message is now in the fixed frame; one that cannot be is gone then
bool Input::place(MessagePtr& message, const FixedFrame& frame) {
  try {
    frame.place(message->header, message->fibers, buffer_);
    return true;
  } catch (const TransformUnavailable& error) {
    transform_error_ = error.what();
  } catch (const std::invalid_argument& error) {
    spares_.add(message);
    log_.refuse(error.what());
  }
  return false;
}

Input::MessagePtr Input::Spares::take() {
  if (messages_.empty()) {
    return std::make_shared<Message>();
  }
  MessagePtr message = std::move(messages_.back());
  messages_.pop_back();
  return message;
}

void Input::overtake(MessagePtr& message) {
  log_.overtake();
  spares_.add(message);
}

}  // namespace fiber_proximity_ros
