#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <tuple>
#include <vector>

#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// The order of pairs of all ranks: by distance or time, then by their segments.
struct PairKey {
  double value = 0.0;
  GlobalSegment a;
  GlobalSegment b;

  auto key() const { return std::tie(value, a.fiber, a.segment, b.fiber, b.segment); }
  bool operator<(const PairKey& other) const { return key() < other.key(); }
};

/// @param contact DistributedContact or DistributedMotionContact
template <class AnyContact>
PairKey pair_key_of(double value, const AnyContact& contact) {
  return {value, {contact.fiber_a, contact.segment_a}, {contact.fiber_b, contact.segment_b}};
}

/// The k-th smallest key of all ranks, none if there are fewer. Collective.
/// @param keys of this rank
std::optional<PairKey> kth_smallest(const Communicator& ranks, std::uint64_t k,
                                    std::vector<PairKey> keys);

/// The k-th smallest key of the contacts of all ranks, none if there are fewer. Collective.
/// @param key_of gives the key of a contact
template <class AnyContact, class KeyOf>
std::optional<PairKey> kth_smallest(const Communicator& ranks, std::uint64_t k,
                                    const std::vector<AnyContact>& contacts, const KeyOf& key_of) {
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
  const std::optional<PairKey> last = kth_smallest(ranks, k, contacts, key_of);
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

}  // namespace fiber
