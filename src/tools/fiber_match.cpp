#include "src/tools/fiber_match.hpp"

#include <algorithm>
#include <unordered_map>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

std::uint32_t points_of(const FiberAssembly& fibers, std::uint32_t fiber) {
  return fibers.offsets()[fiber + 1] - fibers.offsets()[fiber];
}

/// Lists the first few names, and counts the others.
class SomeNames {
 public:
  void add(const std::string& name) {
    if (++count_ <= max_listed) {
      list_ += (list_.empty() ? "" : ", ") + quote(name);
    }
  }
  std::string text(const std::string& what) const {
    return count_ == 0
               ? ""
               : "; " + what + ": " + list_ +
                     (count_ > max_listed ? " and " + std::to_string(count_ - max_listed) + " more"
                                          : "");
  }

 private:
  static constexpr std::size_t max_listed = 3;

  std::string list_;
  std::size_t count_ = 0;
};

/// The indices of a frame's fibres by their names.
std::unordered_map<std::string, std::uint32_t> by_name(const FiberFrame& frame) {
  std::unordered_map<std::string, std::uint32_t> fibers;
  const auto count = static_cast<std::uint32_t>(frame.fibers.fiber_count());
  for (std::uint32_t fiber = 0; fiber < count; ++fiber) {
    fibers.emplace(frame.names.of(fiber), fiber);
  }
  return fibers;
}

}  // namespace

FiberMatch match_fibers(const FiberFrame& from, const FiberFrame& to) {
  FiberMatch match;
  const auto count = static_cast<std::uint32_t>(from.fibers.fiber_count());
  if (from.names == to.names && from.fibers.offsets() == to.fibers.offsets()) {
    for (std::uint32_t fiber = 0; fiber < count; ++fiber) {
      match.before.push_back(fiber);
    }
    match.after = match.before;
    return match;
  }
  std::unordered_map<std::string, std::uint32_t> there = by_name(to);
  SomeNames gone;
  SomeNames changed;
  for (std::uint32_t fiber = 0; fiber < count; ++fiber) {
    const std::string name = from.names.of(fiber);
    const auto found = there.find(name);
    if (found == there.end()) {
      gone.add(name);
      match.others.push_back(fiber);
      continue;
    }
    if (points_of(to.fibers, found->second) == points_of(from.fibers, fiber)) {
      match.before.push_back(fiber);
      match.after.push_back(found->second);
    } else {
      changed.add(name);
      match.others.push_back(fiber);
    }
    there.erase(found);
  }
  SomeNames added;
  for (std::uint32_t fiber = 0; fiber < to.fibers.fiber_count(); ++fiber) {
    const std::string name = to.names.of(fiber);
    if (there.count(name) > 0) {
      added.add(name);
    }
  }
  if (!match.others.empty() || !there.empty()) {
    std::string kinds =
        gone.text("gone") + changed.text("of other numbers of points") + added.text("new");
    kinds.erase(0, 2);
    match.difference = "frames " + std::to_string(from.frame) + " and " + std::to_string(to.frame) +
                       " have different fibres (" + kinds +
                       "): of these only the contacts that frame " + std::to_string(from.frame) +
                       " has itself";
  }
  return match;
}

bool is_all(const std::vector<std::uint32_t>& fibers, std::size_t count) {
  std::size_t index = 0;
  while (index < fibers.size() && fibers[index] == index) {
    ++index;
  }
  return index == fibers.size() && index == count;
}

}  // namespace fiber
