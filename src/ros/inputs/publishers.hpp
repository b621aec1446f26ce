#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace fiber_proximity_ros {

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

/// The publishers of a topic of which each message is all that there is.
class Publishers {
 public:
  /// @param publisher name of the node that has sent the message
  /// @param sequence  its header.seq, as it arrived; none where nobody numbers them
  /// @returns a warning where two publishers take each other's place by turns; else empty
  std::string add(const std::string& publisher, std::optional<std::uint32_t> sequence);

  /// As SequenceGaps::count().
  std::int64_t lost_messages() const { return gaps_.count(); }

 private:
  SequenceGaps gaps_;
  PublisherTurns turns_;
};

}  // namespace fiber_proximity_ros
