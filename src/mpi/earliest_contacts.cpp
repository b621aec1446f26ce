#include "src/mpi/earliest_contacts.hpp"

#include <algorithm>
#include <optional>
#include <vector>

#include "src/mpi/kth_smallest.hpp"
#include "src/query/motion_evaluator.hpp"

namespace fiber {
namespace {

PairKey sort_key(double value, const DistributedMotionContact& contact) {
  return {value, {contact.fiber_a, contact.segment_a}, {contact.fiber_b, contact.segment_b}};
}

/// Leaves the so many first ones of all ranks.
/// @param value   what they are sorted by, then by their segments
/// @param dropped is called with those that go
/// @return whether any go, of any rank
template <class Value, class Dropped>
bool keep_first(const Communicator& ranks, std::uint64_t most, const Value& value,
                const Dropped& dropped, std::vector<DistributedMotionContact>& contacts) {
  if (most == 0 || ranks.sum(contacts.size()) <= most) {
    return false;
  }
  std::vector<PairKey> places;
  places.reserve(contacts.size());
  for (const DistributedMotionContact& contact : contacts) {
    places.push_back(sort_key(value(contact), contact));
  }
  const std::optional<PairKey> last = kth_smallest(ranks, most, std::move(places));
  std::size_t kept = 0;
  for (const DistributedMotionContact& contact : contacts) {
    if (*last < sort_key(value(contact), contact)) {
      dropped(contact);
    } else {
      contacts[kept++] = contact;
    }
  }
  contacts.resize(kept);
  return true;
}

void sort(std::vector<DistributedMotionContact>& contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const DistributedMotionContact& x, const DistributedMotionContact& y) {
              return x.key() < y.key();
            });
}

}  // namespace

void keep_earliest(const Communicator& ranks, const MotionOptions& options,
                   DistributedMotionResult& result) {
  result.complete = ranks.all(result.complete);
  result.limit_reached = !ranks.all(!result.limit_reached);
  if (result.limit_reached) {  // there are more pairs than may be examined: none is reported
    result.contacts.clear();
    result.touching.clear();
  }
  double others_lower = result.complete ? 1.0 : 0.0;
  const bool are_more_touching = keep_first(
      ranks, options.contact_limit, [](const auto& /*contact*/) { return 0.0; },
      [](const auto& /*contact*/) {}, result.touching);
  const bool are_more = keep_first(
      ranks, max_reported(options), [](const auto& contact) { return contact.lower; },
      [&](const auto& contact) { others_lower = std::min(others_lower, contact.lower); },
      result.contacts);
  sort(result.contacts);
  sort(result.touching);
  result.limit_reached =
      result.limit_reached || are_more_touching || (are_more && options.type != MotionType::FIRST);
  result.others_lower = ranks.min(are_more_touching ? 0.0 : others_lower);
}

}  // namespace fiber
