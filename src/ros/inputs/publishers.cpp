#include "src/ros/inputs/publishers.hpp"

#include <algorithm>

#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

/// How many publishers are remembered. Tools that have another name in each run come and go.
constexpr std::size_t max_publishers = 64;

}  // namespace

void SequenceGaps::add(const std::string& publisher, std::uint32_t sequence) {
  is_numbered_ = is_numbered_ || sequence != 0;
  const auto found =
      std::find_if(publishers_.begin(), publishers_.end(),
                   [&publisher](const Publisher& other) { return other.name == publisher; });
  if (found == publishers_.end()) {
    if (publishers_.size() == max_publishers) {
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

std::string Publishers::add(const std::string& publisher, std::optional<std::uint32_t> sequence) {
  if (sequence) {
    gaps_.add(publisher, *sequence);
  }
  const std::string other = turns_.add(publisher);
  if (other.empty()) {
    return "";
  }
  const auto [first, second] = std::minmax(other, publisher);  // said once
  return "messages come from " + fiber::quote(first) + " and " + fiber::quote(second) +
         " by turns, and each replaces the fibres of the other: give them topics of their own";
}

}  // namespace fiber_proximity_ros
