// A sort by samples: what each rank has is sampled in equal steps, and the samples of all, sorted,
// say where the part of each rank begins.
#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <iterator>
#include <tuple>
#include <utility>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/plain_contact.hpp"

namespace fiber {
namespace {

// From each rank, and no fewer than there are ranks: then no part is twice as large as it should
// be.
constexpr std::size_t fewest_samples = 64;

struct ContactKey {
  GlobalSegment a;
  GlobalSegment b;

  auto key() const { return std::tie(a.fiber, a.segment, b.fiber, b.segment); }
  bool operator<(const ContactKey& other) const { return key() < other.key(); }
};

ContactKey key_of(const PlainContact& contact) { return {contact.a, contact.b}; }

ContactKey key_of(const DistributedMotionContact& contact) {
  return {{contact.fiber_a, contact.segment_a}, {contact.fiber_b, contact.segment_b}};
}

/// A contact that stands for those from the sample before it on.
struct ContactSample {
  ContactKey key;
  std::uint64_t weight = 0;
};

template <class T>
std::vector<ContactSample> samples_of(const std::vector<T>& contacts, std::size_t most) {
  std::vector<ContactSample> samples;
  const std::size_t count = std::min(most, contacts.size());
  std::size_t begin = 0;
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t end =
        contacts.size() / count * (i + 1) + contacts.size() % count * (i + 1) / count;
    samples.push_back({key_of(contacts[end - 1]), end - begin});
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
  to[0] = samples_of(contacts, std::max(fewest_samples, size));
  std::vector<ContactSample> samples;
  for (const std::vector<ContactSample>& some : ranks.exchange(to)) {
    samples.insert(samples.end(), some.begin(), some.end());
  }
  std::sort(samples.begin(), samples.end(),
            [](const ContactSample& x, const ContactSample& y) { return x.key < y.key; });
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
  splitters.resize(static_cast<std::size_t>(ranks.broadcast(std::uint64_t{splitters.size()})));
  MPI_Bcast(splitters.data(), static_cast<int>(splitters.size() * sizeof(ContactKey)), MPI_BYTE, 0,
            ranks.handle());
  return splitters;
}

template <class T>
void sort(std::vector<T>& contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const T& x, const T& y) { return key_of(x) < key_of(y); });
}

/// @param contacts that may travel
template <class T>
void sort_all(const Communicator& ranks, std::vector<T>& contacts) {
  sort(contacts);
  const std::vector<ContactKey> splitters = find_splitters(ranks, contacts);
  PerRank<T> parts(static_cast<std::size_t>(ranks.size()));
  auto begin = contacts.begin();
  for (std::size_t part = 0; part <= splitters.size(); ++part) {
    const auto end = part == splitters.size()
                         ? contacts.end()
                         : std::upper_bound(begin, contacts.end(), splitters[part],
                                            [](const ContactKey& key, const T& contact) {
                                              return key < key_of(contact);
                                            });
    parts[part].assign(begin, end);
    begin = end;
  }
  contacts = {};
  parts = ranks.exchange(std::exchange(parts, {}));
  for (std::vector<T>& some : parts) {
    contacts.insert(contacts.end(), some.begin(), some.end());
    some = {};
  }
  sort(contacts);
}

}  // namespace

void sort_over_ranks(MPI_Comm ranks, DistributedResult& result) {
  std::vector<PlainContact> contacts;
  contacts.reserve(result.contacts.size());
  std::transform(result.contacts.begin(), result.contacts.end(), std::back_inserter(contacts),
                 plain_contact);
  result.contacts = {};
  sort_all(Communicator(ranks), contacts);
  result.contacts.reserve(contacts.size());
  std::transform(contacts.begin(), contacts.end(), std::back_inserter(result.contacts),
                 contact_from);
}

void sort_over_ranks(MPI_Comm ranks, DistributedMotionResult& result) {
  const Communicator all(ranks);
  sort_all(all, result.contacts);
  sort_all(all, result.touching);
}

}  // namespace fiber
