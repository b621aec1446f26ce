#pragma once

#include <ros/time.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <string>
#include <utility>
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

/// Counts the messages of a topic that were sent but never arrived: a publisher numbers its
/// messages one by one, so what is missing between two that have arrived was lost.
///
/// Each publisher of a topic has numbers of its own. One whose numbers go back has started again.
/// Where a publisher passes the numbers of others on (a bag that is played, topic_tools), messages
/// that were lost before it count, too.
class SequenceGaps {
 public:
  /// @param publisher name of the node that has sent the message
  /// @param sequence its header.seq, as it arrived
  void add(const std::string& publisher, std::uint32_t sequence);

  /// Lost messages of all publishers; -1 while none has numbered its messages.
  std::int64_t count() const { return is_numbered_ ? static_cast<std::int64_t>(count_) : -1; }

 private:
  struct Publisher {
    std::string name;
    std::uint32_t last = 0;
  };

  std::vector<Publisher> publishers_;  // the one heard from last comes first
  std::uint64_t count_ = 0;
  bool is_numbered_ = false;
};

/// Tells of two publishers of a topic that take turns. One that another has taken over from is none
/// of them.
class PublisherTurns {
 public:
  /// @param publisher name of the node that has sent the message
  /// @returns the other one, whose message came before it as one of this publisher had come before
  ///          that; empty: there is none
  std::string add(const std::string& publisher) {
    if (publisher == last_) {
      return "";
    }
    const bool is_back = publisher == before_;
    before_ = std::exchange(last_, publisher);
    return is_back ? before_ : "";
  }

 private:
  std::string before_;
  std::string last_;
};

}  // namespace fiber_proximity_ros
