#include "src/mpi/select_contacts.hpp"

#include <algorithm>
#include <cstddef>
#include <limits>
#include <optional>
#include <utility>

#include "src/mpi/kth_smallest.hpp"
#include "src/query/motion_evaluator.hpp"

namespace fiber {
namespace {

/// @param contact DistributedContact or DistributedMotionContact
template <class AnyContact>
PairKey pair_key_of(double value, const AnyContact& contact) {
  return {value, {contact.fiber_a, contact.segment_a}, {contact.fiber_b, contact.segment_b}};
}

/// The k-th smallest key of the contacts of all ranks, none if there are fewer. Collective.
/// @param key_of gives the key of a contact
template <class AnyContact, class KeyOf>
std::optional<PairKey> kth_smallest_of(const Communicator& ranks, std::uint64_t k,
                                       const std::vector<AnyContact>& contacts,
                                       const KeyOf& key_of) {
  std::vector<PairKey> keys;
  keys.reserve(contacts.size());
  for (const AnyContact& contact : contacts) {
    keys.push_back(key_of(contact));
  }
  return kth_smallest(ranks, k, std::move(keys));
}

/// Leaves of the contacts of all ranks the k with the smallest keys. Collective.
/// @param key_of  gives the key of a contact
/// @param dropped is called with each contact of this rank that goes
/// @return whether any go, of any rank
template <class AnyContact, class KeyOf, class Dropped>
bool keep_k_smallest(const Communicator& ranks, std::uint64_t k, const KeyOf& key_of,
                     const Dropped& dropped, std::vector<AnyContact>& contacts) {
  if (ranks.sum(contacts.size()) <= k) {
    return false;
  }
  const std::optional<PairKey> last = kth_smallest_of(ranks, k, contacts, key_of);
  std::size_t kept = 0;
  for (const AnyContact& contact : contacts) {
    if (*last < key_of(contact)) {
      dropped(contact);
    } else {
      contacts[kept++] = contact;
    }
  }
  contacts.resize(kept);
  return true;
}

PairKey distance_key(const DistributedContact& contact) {
  return pair_key_of(contact.distance, contact);
}

}  // namespace

double margin_of_closest(const Communicator& ranks, std::uint64_t count,
                         const std::vector<DistributedContact>& contacts) {
  const std::optional<PairKey> last = kth_smallest_of(ranks, count, contacts, distance_key);
  if (!last) {
    return std::numeric_limits<double>::infinity();
  }
  double margin = last->value;
  for (const DistributedContact& contact : contacts) {
    if (!(*last < distance_key(contact))) {
      margin = std::max(margin, contact.upper);
    }
  }
  return ranks.max(margin);
}

bool keep_closest(const Communicator& ranks, std::uint64_t count, DistributedResult& result) {
  return keep_k_smallest(
      ranks, count, distance_key,
      [&](const DistributedContact& contact) {
        result.others_lower = std::min(result.others_lower, contact.lower);
      },
      result.contacts);
}

void keep_earliest(const Communicator& ranks, const MotionOptions& options,
                   DistributedMotionResult& result) {
  result.complete = ranks.all(result.complete);
  result.limit_reached = !ranks.all(!result.limit_reached);
  if (result.limit_reached) {  // there are more pairs than may be examined: none is reported
    result.contacts.clear();
    result.touching.clear();
  }
  double others_lower = result.complete ? 1.0 : 0.0;
  const auto touching_key = [](const DistributedMotionContact& contact) {
    return pair_key_of(0.0, contact);
  };
  const bool are_more_touching =
      options.contact_limit > 0 && keep_k_smallest(
                                       ranks, options.contact_limit, touching_key,
                                       [](const auto& /*contact*/) {}, result.touching);
  const auto time_key = [](const DistributedMotionContact& contact) {
    return pair_key_of(contact.lower, contact);
  };
  const std::uint64_t max_contacts = max_reported(options);
  const bool are_more =
      max_contacts > 0 &&
      keep_k_smallest(
          ranks, max_contacts, time_key,
          [&](const auto& contact) { others_lower = std::min(others_lower, contact.lower); },
          result.contacts);
  std::sort(result.contacts.begin(), result.contacts.end(), by_key);
  std::sort(result.touching.begin(), result.touching.end(), by_key);
  result.limit_reached =
      result.limit_reached || are_more_touching || (are_more && options.type != MotionType::FIRST);
  result.others_lower = ranks.min(are_more_touching ? 0.0 : others_lower);
}

}  // namespace fiber
