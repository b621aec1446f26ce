#include "src/ros/inputs/sequence_gaps.hpp"

#include <algorithm>

namespace fiber_proximity_ros {
namespace {

/// Publishers remembered at most: tools with names of their own for each run come and go.
constexpr std::size_t most_publishers = 64;

}  // namespace

void SequenceGaps::add(const std::string& publisher, std::uint32_t sequence) {
  is_numbered_ = is_numbered_ || sequence != 0;
  const auto found =
      std::find_if(publishers_.begin(), publishers_.end(),
                   [&publisher](const Publisher& other) { return other.name == publisher; });
  if (found == publishers_.end()) {
    if (publishers_.size() == most_publishers) {
      publishers_.pop_back();
    }
    publishers_.insert(publishers_.begin(), {publisher, sequence});
    return;
  }
  if (sequence > found->last) {
    count_ += sequence - found->last - 1;
  }
  found->last = sequence;
  std::rotate(publishers_.begin(), found, found + 1);
}

}  // namespace fiber_proximity_ros
