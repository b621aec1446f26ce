#include "src/mpi/closest_contacts.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "src/mpi/kth_smallest.hpp"

namespace fiber {
namespace {

PairKey sort_key(const DistributedContact& contact) {
  return {
      contact.distance, {contact.fiber_a, contact.segment_a}, {contact.fiber_b, contact.segment_b}};
}

bool is_closer(const DistributedContact& x, const DistributedContact& y) {
  return sort_key(x) < sort_key(y);
}

/// The so many closest ones of this rank first; how many these are.
std::size_t closest_first(std::uint64_t count, std::vector<DistributedContact>& contacts) {
  const std::uint64_t kept = std::min<std::uint64_t>(count, contacts.size());
  if (kept < contacts.size()) {
    std::nth_element(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(kept),
                     contacts.end(), is_closer);
  }
  return kept;
}

/// None if there are fewer.
std::optional<PairKey> find_last_of_closest(const Communicator& ranks, std::uint64_t count,
                                            std::vector<DistributedContact>& contacts) {
  const std::size_t kept = closest_first(count, contacts);
  std::vector<PairKey> places;
  places.reserve(kept);
  std::transform(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(kept),
                 std::back_inserter(places), sort_key);
  return kth_smallest(ranks, count, std::move(places));
}

/// Leaves those that this holds for.
template <class IsKept>
void keep_if(const IsKept& is_kept, DistributedResult& result) {
  std::size_t kept = 0;
  for (const DistributedContact& contact : result.contacts) {
    if (is_kept(contact)) {
      result.contacts[kept++] = contact;
    } else {
      result.others_lower = std::min(result.others_lower, contact.lower);
    }
  }
  result.contacts.resize(kept);
}

}  // namespace

double margin_of_closest(const Communicator& ranks, std::uint64_t count,
                         std::vector<DistributedContact>& contacts) {
  const std::optional<PairKey> last = find_last_of_closest(ranks, count, contacts);
  if (!last) {
    return std::numeric_limits<double>::infinity();
  }
  double margin = last->value;
  for (const DistributedContact& contact : contacts) {
    if (!(*last < sort_key(contact))) {
      margin = std::max(margin, contact.upper);
    }
  }
  return ranks.max(margin);
}

bool keep_closest(const Communicator& ranks, std::uint64_t count, DistributedResult& result) {
  if (ranks.sum(result.contacts.size()) <= count) {
    return false;
  }
  const std::optional<PairKey> last = find_last_of_closest(ranks, count, result.contacts);
  keep_if([&](const DistributedContact& contact) { return !(*last < sort_key(contact)); }, result);
  return true;
}

}  // namespace fiber
