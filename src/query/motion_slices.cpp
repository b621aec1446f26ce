#include "fiber_proximity/query/motion_slices.hpp"

#include <algorithm>

namespace fiber {
namespace {

/// The most contacts to report that begin during the motion, 0 for no limit.
std::size_t most_contacts(const MotionOptions& options) {
  std::size_t most = options.contact_limit;
  if (options.type != MotionType::ALL) {
    const std::size_t asked = options.type == MotionType::FIRST ? 1 : options.max_contacts;
    most = most == 0 ? asked : std::min(most, asked);
  }
  return most;
}

/// Leaves the earliest ones, sorted by key.
/// @return whether there were more
bool keep_earliest(std::size_t most, MotionResult& result) {
  std::vector<MotionContact>& contacts = result.contacts;
  if (most == 0 || contacts.size() <= most) {
    return false;
  }
  std::nth_element(
      contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(most), contacts.end(),
      [](const MotionContact& x, const MotionContact& y) { return x.earlier_than(y); });
  result.others_lower = std::min(result.others_lower, contacts[most].lower);
  contacts.resize(most);
  std::sort(contacts.begin(), contacts.end(),
            [](const MotionContact& x, const MotionContact& y) { return x.key() < y.key(); });
  return true;
}

}  // namespace

void merge_slices(const MotionSlice* slices, std::size_t count, const MotionCandidates& candidates,
                  const MotionOptions& options, MotionResult& result) {
  result.counts = candidates.counts;
  result.counts.primitive_tests += candidates.keys.size();
  result.complete = candidates.are_all && !candidates.are_too_many;
  for (std::size_t i = 0; i < count; ++i) {
    const MotionSlice& slice = slices[i];
    result.contacts.insert(result.contacts.end(), slice.contacts.begin(), slice.contacts.end());
    result.touching.insert(result.touching.end(), slice.touching.begin(), slice.touching.end());
    result.complete = result.complete && slice.complete;
  }
  result.others_lower = result.complete ? 1.0 : 0.0;
  result.limit_reached = candidates.are_too_many;
  if (options.contact_limit > 0 && result.touching.size() > options.contact_limit) {
    result.touching.resize(options.contact_limit);
    result.others_lower = 0.0;
    result.limit_reached = true;
  }
  const bool are_more = keep_earliest(most_contacts(options), result);
  result.limit_reached = result.limit_reached || (are_more && options.type != MotionType::FIRST);
}

}  // namespace fiber
