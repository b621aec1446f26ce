#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace fiber_proximity_ros {

/// Counts the messages of a topic that were sent but never arrived: a publisher numbers its
/// messages one by one, so what is missing between two that have arrived was lost.
///
/// Each publisher of a topic has numbers of its own. One whose numbers go back has started again.
/// What passes other publishers' numbers on (a bag that is played, topic_tools) counts what was
/// lost before, too.
class SequenceGaps {
 public:
  /// @param publisher name of the node that has sent the message
  /// @param sequence its header.seq, as it arrived
  void add(const std::string& publisher, std::uint32_t sequence);

  /// Of all publishers; -1 while none has numbered its messages.
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

}  // namespace fiber_proximity_ros
