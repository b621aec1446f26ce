#include <algorithm>
#include <cstddef>
#include <iterator>
#include <string>
#include <utility>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/plain_contact.hpp"

namespace fiber {

DistributedResult gather(MPI_Comm ranks, const DistributedResult& result, int root) {
  const Communicator all(ranks);
  all.throw_on_all(root >= 0 && root < all.size()
                       ? ""
                       : "root is " + std::to_string(root) + ", there are ranks 0 to " +
                             std::to_string(all.size() - 1));
  PerRank<PlainContact> contacts(static_cast<std::size_t>(all.size()));
  std::vector<PlainContact>& mine = contacts[static_cast<std::size_t>(root)];
  mine.reserve(result.contacts.size());
  std::transform(result.contacts.begin(), result.contacts.end(), std::back_inserter(mine),
                 plain_contact);
  contacts = all.exchange(std::move(contacts));
  DistributedResult gathered;
  gathered.limit_reached = result.limit_reached;
  gathered.complete = result.complete;
  gathered.others_lower = all.min(result.others_lower);
  for (const std::vector<PlainContact>& some : contacts) {
    std::transform(some.begin(), some.end(), std::back_inserter(gathered.contacts), contact_from);
  }
  std::sort(gathered.contacts.begin(), gathered.contacts.end(), is_before);
  return gathered;
}

}  // namespace fiber
