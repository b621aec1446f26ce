#include "src/environment/allowed_parts.hpp"

#include <algorithm>
#include <map>
#include <string_view>

namespace fiber {
namespace {

/// Index of a segment that may be counted from the end.
std::int64_t from_begin(std::int64_t segment, std::int64_t segment_count) {
  return segment < 0 ? segment_count + segment : segment;
}

}  // namespace

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
