#include "src/environment/allowed_contacts.hpp"

#include <algorithm>
#include <map>
#include <set>
#include <stdexcept>
#include <string_view>
#include <utility>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Pairs = std::vector<NamedPair>;

std::string label(const NamedPair& pair) {
  std::string segments;
  for (const std::int32_t segment : pair.segments) {
    segments += (segments.empty() ? "" : ", ") + std::to_string(segment);
  }
  return "pair of object " + quote(pair.object) + " and fiber " + quote(pair.fiber) +
         ", segments [" + shortened(segments) + "]";
}

/// Index of a segment that may be counted from the end.
std::int64_t from_begin(std::int64_t segment, std::int64_t segment_count) {
  return segment < 0 ? segment_count + segment : segment;
}

}  // namespace

void validate(const NamedPair& pair) {
  const auto& segments = pair.segments;
  if (segments.empty()) {
    return;
  }
  if (segments.size() != 2) {
    throw std::invalid_argument(label(pair) +
                                ": segments must be the first and the last one, or empty");
  }
  // With different signs the order depends on the fibre's length.
  if ((segments[0] < 0) == (segments[1] < 0) && segments[0] > segments[1]) {
    throw std::invalid_argument(label(pair) + ": the first segment comes after the last");
  }
}

void AllowedContacts::apply(bool reset, const Pairs& forbid, const Pairs& allow) {
  Pairs pairs = reset ? Pairs() : pairs_;
  std::set<NamedPair> known(pairs.begin(), pairs.end());
  for (const NamedPair& pair : forbid) {
    if (known.erase(pair) == 0) {
      throw std::invalid_argument(label(pair) + ": it is not allowed, so it cannot be taken back");
    }
  }
  const auto is_forbidden = [&known](const NamedPair& pair) { return known.count(pair) == 0; };
  pairs.erase(std::remove_if(pairs.begin(), pairs.end(), is_forbidden), pairs.end());
  for (const NamedPair& pair : allow) {
    validate(pair);
    if (known.insert(pair).second) {
      pairs.push_back(pair);
    }
  }
  pairs_ = std::move(pairs);
}

AllowedPairs resolve(const Pairs& pairs, const std::vector<std::string>& fiber_names) {
  std::multimap<std::string_view, std::uint32_t> fibers;  // those of one name in their order
  if (!pairs.empty()) {
    for (std::size_t i = 0; i < fiber_names.size(); ++i) {
      fibers.emplace(fiber_names[i], static_cast<std::uint32_t>(i));
    }
  }
  AllowedPairs resolved;
  for (const NamedPair& pair : pairs) {
    AllowedPair allowed;
    allowed.object = pair.object;
    if (!pair.segments.empty()) {
      allowed.first_segment = pair.segments[0];
      allowed.last_segment = pair.segments[1];
    }
    if (pair.fiber.empty()) {
      resolved.push_back(allowed);
      continue;
    }
    const auto [begin, end] = fibers.equal_range(pair.fiber);
    for (auto fiber = begin; fiber != end; ++fiber) {
      allowed.fiber = fiber->second;
      resolved.push_back(allowed);
    }
  }
  return resolved;
}

/// Sorts and finds parts by fibre.
struct AllowedParts::OfFiber {
  bool operator()(const Part& a, const Part& b) const { return a.fiber < b.fiber; }
  bool operator()(const Part& a, std::uint32_t fiber) const { return a.fiber < fiber; }
  bool operator()(std::uint32_t fiber, const Part& b) const { return fiber < b.fiber; }
};

AllowedParts::AllowedParts(const AllowedPairs& allowed,
                           const std::vector<EnvironmentObject>& objects) {
  if (allowed.empty()) {
    return;
  }
  parts_.resize(objects.size() + 1);
  std::map<std::string_view, std::size_t> indices{{"", objects.size()}};
  for (std::size_t i = 0; i < objects.size(); ++i) {
    indices.emplace(objects[i].name, i);
  }
  for (const AllowedPair& pair : allowed) {
    if (const auto found = indices.find(pair.object); found != indices.end()) {
      parts_[found->second].push_back({pair.fiber, pair.first_segment, pair.last_segment});
    }
  }
  for (std::vector<Part>& parts : parts_) {
    std::sort(parts.begin(), parts.end(), OfFiber());
  }
}

bool AllowedParts::holds(const FiberAssembly& fibers, SegmentId segment,
                         std::uint32_t object) const {
  if (parts_.empty()) {
    return false;
  }
  const std::vector<std::uint32_t>& offsets = fibers.offsets();
  const std::int64_t count = std::int64_t{offsets[segment.fiber + 1]} - offsets[segment.fiber] - 1;
  const auto holds_segment = [&](const Part& part) {
    return from_begin(part.first_segment, count) <= segment.segment &&
           segment.segment <= from_begin(part.last_segment, count);
  };
  for (const std::vector<Part>* parts : {&parts_[object], &parts_.back()}) {
    for (const std::uint32_t fiber : {segment.fiber, AllowedPair::every_fiber}) {
      const auto [begin, end] = std::equal_range(parts->begin(), parts->end(), fiber, OfFiber());
      if (std::any_of(begin, end, holds_segment)) {
        return true;
      }
    }
  }
  return false;
}

}  // namespace fiber
