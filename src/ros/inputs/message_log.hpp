#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <vector>

#include "fiber_proximity/InputStatistics.h"

namespace fiber_proximity_ros {

/// Counts and logs what becomes of the messages of one topic. Refusals are logged without a flood:
/// a source that sends nonsense does so at camera rate. Each reason is logged at most once a
/// second, so that a frequent one does not hide another; reasons that differ in numbers alone are
/// one. Beyond a few reasons within a second, others are only counted.
class MessageLog {
 public:
  /// Most reasons that are logged within a second.
  static constexpr std::size_t max_reasons = 10;

  /// @param source what the log calls the topic, before its name
  MessageLog(const std::string& topic, const std::string& type, const std::string& source = "");

  void receive() { ++statistics_.received; }
  void accept() { refused_since_.clear(); }
  void overtake() { ++statistics_.overtaken; }
  void refuse(const std::string& reason);

  /// Warns of something that is done with messages; once of what differs in numbers alone.
  void remark(const std::string& text);

  /// Why the last message was refused since one was accepted; empty if none was.
  const std::string& refused_since() const { return refused_since_; }

  /// Name of the topic in the log.
  const std::string& label() const { return label_; }

  /// The counts. They are without an age, and without the number of dropped messages.
  const fiber_proximity::InputStatistics& statistics() const { return statistics_; }

 private:
  struct Reason {
    std::string kind;            ///< the reason without its numbers
    ros::SteadyTime logged;      ///< when it was last; zero: not yet
    std::uint64_t unlogged = 0;  ///< times since
  };

  Reason* place_of(const std::string& kind, const ros::SteadyTime& now);

  std::string label_;
  std::vector<Reason> reasons_;
  std::uint64_t unlogged_ = 0;  // times for reasons that are not among these
  fiber_proximity::InputStatistics statistics_;
  std::string refused_since_;
  std::set<std::string> remarked_;
};

}  // namespace fiber_proximity_ros
