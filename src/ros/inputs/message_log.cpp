#include "src/ros/inputs/message_log.hpp"

#include <ros/console.h>

#include <algorithm>
#include <cctype>

namespace fiber_proximity_ros {
namespace {

/// [s] The shortest time between two logs of one reason.
constexpr double log_interval = 1.0;

bool is_digit(char c) { return std::isdigit(static_cast<unsigned char>(c)) != 0; }

/// The reason without its numbers, of which each message may have its own.
std::string reason_kind(const std::string& reason) {
  constexpr std::size_t longest = 300;
  const std::string text = reason.substr(0, longest);
  std::string kind;
  bool in_number = false;
  for (const char c : text) {
    in_number = is_digit(c) || (in_number && (c == '.' || c == 'e' || c == '-' || c == '+'));
    if (!in_number && c != '-' && c != '+') {
      kind.push_back(c);
    }
  }
  return kind;
}

std::string and_more(std::uint64_t count, const std::string& what) {
  return count == 0 ? "" : " (and " + std::to_string(count) + " more refused " + what + ")";
}

}  // namespace

MessageLog::MessageLog(const std::string& topic, const std::string& type, const std::string& source)
    : label_(source + "'" + topic + "' (" + type + ")") {
  statistics_.topic = topic;
  statistics_.type = type;
  statistics_.dropped = -1;
  statistics_.age = -1.0;
}

void MessageLog::refuse(const std::string& reason) {
  ++statistics_.refused;
  statistics_.last_error = reason;
  refused_since_ = reason;
  const ros::SteadyTime now = ros::SteadyTime::now();
  Reason* const place = place_of(reason_kind(reason), now);
  if (place == nullptr) {
    ++unlogged_;
    return;
  }
  if (!place->logged.isZero() && (now - place->logged).toSec() < log_interval) {
    ++place->unlogged;
    return;
  }
  ROS_ERROR_STREAM(label_ << ": message refused: " << reason << and_more(place->unlogged, "since")
                          << and_more(unlogged_, "for other reasons"));
  place->logged = now;
  place->unlogged = 0;
  unlogged_ = 0;
}

void MessageLog::remark(const std::string& text) {
  if (remarked_.size() < max_reasons && remarked_.insert(reason_kind(text)).second) {
    ROS_WARN_STREAM(label_ << ": " << text);
  }
}

/// Finds or makes the entry of a reason; null if all entries are of reasons of this second.
MessageLog::Reason* MessageLog::place_of(const std::string& kind, const ros::SteadyTime& now) {
  for (Reason& reason : reasons_) {
    if (reason.kind == kind) {
      return &reason;
    }
  }
  if (reasons_.size() < max_reasons) {
    reasons_.push_back({kind, {}});
    return &reasons_.back();
  }
  Reason& oldest =
      *std::min_element(reasons_.begin(), reasons_.end(),
                        [](const Reason& x, const Reason& y) { return x.logged < y.logged; });
  if ((now - oldest.logged).toSec() < log_interval) {
    return nullptr;
  }
  unlogged_ += oldest.unlogged;
  oldest = {kind, {}};
  return &oldest;
}

}  // namespace fiber_proximity_ros
