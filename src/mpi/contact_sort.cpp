// Contacts of all ranks, gathered on one of them or sorted over all. The sort is one by samples:
// what each rank has is sampled in equal steps, and the sorted samples of all say where the part of
// each rank begins.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {
namespace {

// From each rank, and no fewer than there are ranks: then no part is twice as large as it should
// be.
constexpr std::size_t min_samples = 64;

/// The base that contacts are sorted by.
using ContactKey = BasicSegmentIdPair<std::uint64_t>;

/// A contact that stands for those from the sample before it on.
struct ContactSample {
  ContactKey key;
  std::uint64_t weight = 0;
};

template <class T>
std::vector<ContactSample> samples_of(const std::vector<T>& contacts, std::size_t max_samples) {
  std::vector<ContactSample> samples;
  const std::size_t count = std::min(max_samples, contacts.size());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t end =
        contacts.size() / count * (i + 1) + contacts.size() % count * (i + 1) / count;
    samples.push_back({contacts[end - 1], end - begin});
    begin = end;
  }
  return samples;
}

/// The last keys of all ranks' parts but the last one. Fewer for a few contacts: the other ranks
/// get none.
template <class T>
std::vector<ContactKey> find_splitters(const Communicator& ranks, const std::vector<T>& contacts) {
  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<ContactSample> to(size);
  to[0] = samples_of(contacts, std::max(min_samples, size));
  std::vector<ContactSample> samples = joined(ranks.exchange(to));
  std::sort(samples.begin(), samples.end(),
            [](const ContactSample& x, const ContactSample& y) { return by_key(x.key, y.key); });
  const std::uint64_t all = ranks.sum(contacts.size());
  std::vector<ContactKey> splitters;
  std::uint64_t before = 0;
  for (const ContactSample& sample : samples) {
    before += sample.weight;
    // all * rank / size without a product beyond 64 bits.
    while (splitters.size() + 1 < size &&
           before >=
               all / size * (splitters.size() + 1) + all % size * (splitters.size() + 1) / size) {
      splitters.push_back(sample.key);
    }
  }
  return ranks.broadcast(std::move(splitters));
}

template <class T>
void sort_all(const Communicator& ranks, std::vector<T>& contacts) {
  std::sort(contacts.begin(), contacts.end(), by_key);
  if (ranks.size() == 1) {
    return;
  }
  const std::vector<ContactKey> splitters = find_splitters(ranks, contacts);
  PerRank<T> parts(static_cast<std::size_t>(ranks.size()));
  auto begin = contacts.begin();
  for (std::size_t part = 0; part <= splitters.size(); ++part) {
    const auto end = part == splitters.size()
                         ? contacts.end()
                         : std::upper_bound(begin, contacts.end(), splitters[part], by_key);
    parts[part].assign(begin, end);
    begin = end;
  }
  contacts = {};
  parts = ranks.exchange(std::exchange(parts, {}));
  std::size_t count = 0;
  for (const std::vector<T>& some : parts) {
    count += some.size();
  }
  contacts.reserve(count);  // a list that grows would be there twice
  for (std::vector<T>& some : parts) {
    contacts.insert(contacts.end(), some.begin(), some.end());
    some = {};
  }
  std::sort(contacts.begin(), contacts.end(), by_key);
}

}  // namespace

DistributedResult gather(MPI_Comm ranks, const DistributedResult& result, int root) {
  const Communicator all(ranks);
  all.throw_on_all(root >= 0 && root < all.size()
                       ? ""
                       : "root is " + std::to_string(root) + ", there are ranks 0 to " +
                             std::to_string(all.size() - 1));
  PerRank<DistributedContact> contacts(static_cast<std::size_t>(all.size()));
  contacts[static_cast<std::size_t>(root)] = result.contacts;
  DistributedResult gathered;
  gathered.contacts = joined(all.exchange(std::move(contacts)));
  std::sort(gathered.contacts.begin(), gathered.contacts.end(), by_key);
  gathered.limit_reached = result.limit_reached;
  gathered.complete = result.complete;
  gathered.others_lower = all.min(result.others_lower);
  return gathered;
}

void sort_over_ranks(MPI_Comm ranks, DistributedResult& result) {
  sort_all(Communicator(ranks), result.contacts);
}

void sort_over_ranks(MPI_Comm ranks, DistributedMotionResult& result) {
  const Communicator all(ranks);
  sort_all(all, result.contacts);
  sort_all(all, result.touching);
}

}  // namespace fiber
