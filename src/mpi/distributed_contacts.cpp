#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {
namespace {

/// A contact as it travels.
struct PlainContact {
  GlobalSegment a;
  GlobalSegment b;
  double s, t, distance, lower, upper;
  PlainPoint point_a, point_b, normal;
};

PlainContact plain_contact(const DistributedContact& contact) {
  return {{contact.fiber_a, contact.segment_a},
          {contact.fiber_b, contact.segment_b},
          contact.s,
          contact.t,
          contact.distance,
          contact.lower,
          contact.upper,
          plain(contact.point_a),
          plain(contact.point_b),
          plain(contact.normal)};
}

DistributedContact contact_from(const PlainContact& contact) {
  return {contact.a.fiber,
          contact.a.segment,
          contact.b.fiber,
          contact.b.segment,
          contact.s,
          contact.t,
          contact.distance,
          contact.lower,
          contact.upper,
          vector_of(contact.point_a),
          vector_of(contact.point_b),
          vector_of(contact.normal)};
}

}  // namespace

DistributedResult gather(MPI_Comm ranks, const DistributedResult& result, int root) {
  const Communicator all(ranks);
  all.agree(root >= 0 && root < all.size()
                ? ""
                : "root is " + std::to_string(root) + ", there are ranks 0 to " +
                      std::to_string(all.size() - 1));
  PerRank<PlainContact> contacts(static_cast<std::size_t>(all.size()));
  std::vector<PlainContact>& mine = contacts[static_cast<std::size_t>(root)];
  mine.reserve(result.contacts.size());
  std::transform(result.contacts.begin(), result.contacts.end(), std::back_inserter(mine),
                 plain_contact);
  contacts = all.exchange(contacts);
  DistributedResult gathered;
  gathered.limit_reached = result.limit_reached;
  gathered.complete = result.complete;
  gathered.others_lower = all.smallest(result.others_lower);
  for (const std::vector<PlainContact>& some : contacts) {
    std::transform(some.begin(), some.end(), std::back_inserter(gathered.contacts), contact_from);
  }
  std::sort(
      gathered.contacts.begin(), gathered.contacts.end(),
      [](const DistributedContact& x, const DistributedContact& y) { return x.key() < y.key(); });
  return gathered;
}

}  // namespace fiber
