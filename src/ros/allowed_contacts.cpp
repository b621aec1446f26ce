#include "fiber_proximity/ros/allowed_contacts.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using Pair = fiber_proximity::AllowedPair;
using Pairs = std::vector<Pair>;

std::string label(const Pair& pair) {
  std::string segments;
  for (const std::int32_t segment : pair.segments) {
    segments += (segments.empty() ? "" : ", ") + std::to_string(segment);
  }
  return "pair of object '" + pair.object + "' and fiber '" + pair.fiber + "', segments [" +
         segments + "]";
}

Pairs::iterator find(Pairs& pairs, const Pair& pair) {
  return std::find_if(pairs.begin(), pairs.end(), [&pair](const Pair& other) {
    return other.object == pair.object && other.fiber == pair.fiber &&
           other.segments == pair.segments;
  });
}

}  // namespace

void validate(const Pair& pair) {
  const auto& segments = pair.segments;
  if (segments.empty()) {
    return;
  }
  if (segments.size() != 2) {
    throw std::invalid_argument(label(pair) +
                                ": segments must be the first and the last one, or empty");
  }
  // Of different signs, the order depends on the fibre's length.
  if ((segments[0] < 0) == (segments[1] < 0) && segments[0] > segments[1]) {
    throw std::invalid_argument(label(pair) + ": the first segment comes after the last");
  }
}

void AllowedContacts::apply(const fiber_proximity::AllowPairs::Request& request) {
  Pairs pairs = request.reset != 0 ? Pairs() : pairs_;
  for (const Pair& pair : request.forbid) {
    const auto found = find(pairs, pair);
    if (found == pairs.end()) {
      throw std::invalid_argument(label(pair) + ": it is not allowed, so it cannot be taken back");
    }
    pairs.erase(found);
  }
  for (const Pair& pair : request.allow) {
    validate(pair);
    if (find(pairs, pair) == pairs.end()) {
      pairs.push_back(pair);
    }
  }
  pairs_ = std::move(pairs);
}

fiber::AllowedPairs AllowedContacts::resolve(const std::vector<std::string>& fiber_names) const {
  fiber::AllowedPairs resolved;
  for (const Pair& pair : pairs_) {
    fiber::AllowedPair allowed;
    allowed.object = pair.object;
    if (!pair.segments.empty()) {
      allowed.first_segment = pair.segments[0];
      allowed.last_segment = pair.segments[1];
    }
    if (pair.fiber.empty()) {
      resolved.push_back(allowed);
      continue;
    }
    for (std::size_t i = 0; i < fiber_names.size(); ++i) {
      if (fiber_names[i] == pair.fiber) {
        allowed.fiber = static_cast<std::uint32_t>(i);
        resolved.push_back(allowed);
      }
    }
  }
  return resolved;
}

}  // namespace fiber_proximity_ros
