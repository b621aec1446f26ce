#include "src/ros/inputs/input.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cassert>
#include <sstream>
#include <stdexcept>

namespace fiber_proximity_ros {

Input::Input(InputOptions options, const InputTiming& timing, Worker& worker)
    : options_(std::move(options)),
      timing_(timing),
      log_(options_.topic, options_.type, "input "),
      stamps_(timing),
      reader_(options_),
      transforms_(timing, log_),
      trial_(options_.cost, worker) {}

void Input::receive(const ReceivedMessage& message, FixedFrame& frame) {
  log_.receive();
  if (const std::string warning = publishers_.add(message.publisher, message.sequence);
      !warning.empty()) {
    log_.remark(warning);
  }
  if (trial_.budget().is_closed()) {
    log_.refuse(trial_.budget().problem());
    return;
  }
  try {
    FiberMessagePtr fibers = reader_.read(message.read, stamps_);
    if (fibers == nullptr) {
      return;
    }
    stamps_.receive(*fibers);
    frame.adopt(fibers->header.frame_id);
    transforms_.add(std::move(fibers));
    for (const std::string& remark : reader_.remarks()) {
      log_.remark(remark);
    }
    message.keep();
  } catch (const std::invalid_argument& error) {
    log_.refuse(error.what());
  }
}

std::vector<ros::Time> Input::place_waiting(const FixedFrame& frame,
                                            const fiber::QueryOptions& answered) {
  overtake_placed(timing_.queue_size());
  std::vector<ros::Time> stamps;
  for (FiberMessagePtr& message : take_placed(frame)) {
    if (trial_.is_running()) {
      log_.overtake();  // the one before it has its turn
    } else if (trial_.budget().is_to_be_tried(message->fibers)) {
      reader_.share(message);
      trial_.begin(std::move(message), answered);
    } else {
      stamps.push_back(message->stamp);
      stamps_.place(*message);
      placed_.push_back(std::move(message));
    }
  }
  return stamps;
}

/// @returns the message that was tried where there is one, else those that have their transforms
std::vector<FiberMessagePtr> Input::take_placed(const FixedFrame& frame) {
  if (!trial_.is_running()) {
    return transforms_.place(frame);
  }
  if (!trial_.is_ready()) {
    return {};
  }
  if (FiberMessagePtr tried = trial_.end()) {
    return {std::move(tried)};
  }
  log_.refuse(trial_.budget().problem());
  leave_out();
  return {};
}

/// Gives back the memory of its fibres.
void Input::leave_out() {
  was_left_out_ = true;
  has_fibers_ = false;
  transforms_.clear();
  placed_.clear();
  current_ = std::make_shared<FiberMessage>();
  reader_.release();
}

void Input::accept(const ros::Time& stamp) {
  while (placed_.front()->stamp < stamp) {
    overtake_placed(placed_.size() - 1);
    assert(!placed_.empty());
  }
  assert(placed_.front()->stamp == stamp);
  if (staleness_) {
    speeds_.forget();
  } else if (timing_.bounds_latency) {
    speeds_.take(*current_, *placed_.front());
  }
  current_ = std::move(placed_.front());
  placed_.pop_front();
  has_fibers_ = true;
  log_.accept();
  if (staleness_) {
    staleness_.reset();
    ROS_INFO_STREAM(log_.label() << ": new messages again");
  }
}

/// Overtakes the oldest of the placed messages until so many are left.
void Input::overtake_placed(std::size_t left) {
  for (; placed_.size() > left; placed_.pop_front()) {
    log_.overtake();
  }
}

bool Input::expire(const ros::Time& now, bool is_unmatched) {
  const bool has_stopped = stamps_.has_placed() && is_silent(now);
  if (!has_stopped && !is_unmatched) {
    return false;
  }
  if (staleness_ && staleness_->is_silent == has_stopped) {
    return false;
  }
  const bool was_fresh = is_fresh();
  if (has_stopped) {
    overtake_placed(0);
  }
  staleness_ = Staleness{has_stopped, has_stopped ? silence() : mismatch()};
  ROS_WARN_STREAM(log_.label() << ": " << staleness_->reason << "; its " << fibers().fiber_count()
                               << " fibre(s) are left out");
  return was_fresh;
}

/// Tells why the fibres of an input that has fallen silent are stale.
std::string Input::silence() const {
  std::ostringstream reason;
  reason << "no new message for " << timing_.input_timeout << " s"
         << (stamps_.is_repeating() ? ", its messages repeat their stamp" : "");
  if (!log_.refused_since().empty()) {
    reason << ", its last one was refused: " << log_.refused_since();
  }
  return reason.str();
}

/// Tells why the fibres are stale of an input whose messages match those of no other input.
std::string Input::mismatch() const {
  std::ostringstream reason;
  reason << "no stamp within " << timing_.synchronize_slop
         << " s (synchronize_slop) of those of the other inputs for " << timing_.input_timeout
         << " s, the newest is " << *stamps_.last_received();
  return reason.str();
}

void Input::reset() {
  transforms_.clear();
  trial_.cancel();
  placed_.clear();
  has_fibers_ = false;
  staleness_.reset();
  stamps_ = InputStamps(timing_);
}

std::optional<Unknown> Input::unknown() const {
  const InputBudget& budget = trial_.budget();
  Unknown unknown{options_.topic, "input " + options_.topic, stamps_.known_since(), "", true};
  if (is_fresh()) {
    unknown.since = current_->stamp;
    unknown.why = current_->missing;
    if (unknown.why.empty() && timing_.bounds_latency && !speeds_.speeds()) {
      unknown.why =
          "how fast its fibres move is not known before a second message of the same fibres "
          "(latency_compensation)";
    }
    return unknown.why.empty() ? std::nullopt : std::make_optional(unknown);
  }
  if (!budget.problem().empty()) {
    unknown.since = budget.since();
    unknown.why = budget.problem();
    return unknown;
  }
  if (!options_.required) {
    return std::nullopt;
  }
  unknown.is_logged = staleness_.has_value();
  unknown.why = staleness_ ? staleness_->reason : absence();
  return unknown;
}

double Input::uncertainty(std::size_t fiber, const ros::Time& now) const {
  if (!timing_.bounds_latency || !speeds_.speeds()) {
    return options_.uncertainty;  // without speeds the input counts as unknown
  }
  const double age = std::max(0.0, (now - current_->stamp).toSec());
  return std::min(options_.uncertainty + age * (*speeds_.speeds())[fiber],
                  fiber::FiberAssembly::max_coordinate);
}

/// Tells why there have been no fibres yet.
std::string Input::absence() const {
  const std::string reason = stamps_.has_placed()
                                 ? "no message that belongs to those of other inputs yet"
                                 : "no message yet";
  const std::string& refused = log_.refused_since();
  return refused.empty() ? reason : reason + " but what was refused: " + refused;
}

fiber_proximity::InputStatistics Input::statistics(const ros::Time& now) const {
  const MissingPointCounts& missing = reader_.missing();
  fiber_proximity::InputStatistics statistics = log_.statistics();
  statistics.dropped = publishers_.lost_messages();
  statistics.missing_points = missing.points;
  statistics.missing_fibers = missing.fibers;
  statistics.lone_points = missing.lone_points;
  statistics.fibers = is_fresh() ? static_cast<std::uint32_t>(fibers().fiber_count()) : 0;
  statistics.age = has_fibers_ ? (now - current_->arrival).toSec() : -1.0;
  statistics.stale = staleness_.has_value();
  return statistics;
}

}  // namespace fiber_proximity_ros
