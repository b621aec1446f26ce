#include "src/mpi/closest_contacts.hpp"

#include <algorithm>
#include <limits>
#include <optional>

#include "src/mpi/kth_smallest.hpp"

namespace fiber {
namespace {

PairKey distance_key(const DistributedContact& contact) {
  return pair_key_of(contact.distance, contact);
}

}  // namespace

double margin_of_closest(const Communicator& ranks, std::uint64_t count,
                         const std::vector<DistributedContact>& contacts) {
  const std::optional<PairKey> last = kth_smallest(ranks, count, contacts, distance_key);
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

}  // namespace fiber
