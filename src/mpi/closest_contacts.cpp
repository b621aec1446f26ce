#include "src/mpi/closest_contacts.hpp"

#include <algorithm>
#include <iterator>
#include <limits>
#include <optional>
#include <utility>

#include "src/mpi/first_places.hpp"

namespace fiber {
namespace {

Place place_of(const DistributedContact& contact) {
  return {
      contact.distance, {contact.fiber_a, contact.segment_a}, {contact.fiber_b, contact.segment_b}};
}

bool is_closer(const DistributedContact& x, const DistributedContact& y) {
  return place_of(x) < place_of(y);
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
std::optional<Place> find_last_of_closest(const Communicator& ranks, std::uint64_t count,
                                          std::vector<DistributedContact>& contacts) {
  const std::size_t kept = closest_first(count, contacts);
  std::vector<Place> places;
  places.reserve(kept);
  std::transform(contacts.begin(), contacts.begin() + static_cast<std::ptrdiff_t>(kept),
                 std::back_inserter(places), place_of);
  return last_of_first(ranks, count, std::move(places));
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

/// Where contacts of a pair of fibres meet.
std::size_t home_of(const DistributedContact& contact, std::size_t size) {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;  // spreads neighbouring numbers
  return ((contact.fiber_a * odd ^ contact.fiber_b) * odd >> 32U) % size;
}

bool are_of_same_fibers(const Place& x, const Place& y) {
  return x.a.fiber == y.a.fiber && x.b.fiber == y.b.fiber;
}

}  // namespace

double margin_of_closest(const Communicator& ranks, std::uint64_t count,
                         std::vector<DistributedContact>& contacts) {
  const std::optional<Place> last = find_last_of_closest(ranks, count, contacts);
  if (!last) {
    return std::numeric_limits<double>::infinity();
  }
  double margin = last->value;
  for (const DistributedContact& contact : contacts) {
    if (!(*last < place_of(contact))) {
      margin = std::max(margin, contact.upper);
    }
  }
  return ranks.largest(margin);
}

bool keep_closest(const Communicator& ranks, std::uint64_t count, DistributedResult& result) {
  if (ranks.sum(result.contacts.size()) <= count) {
    return false;
  }
  const std::optional<Place> last = find_last_of_closest(ranks, count, result.contacts);
  keep_if([&](const DistributedContact& contact) { return !(*last < place_of(contact)); }, result);
  return true;
}

void keep_closest_of_fibers(const Communicator& ranks, DistributedResult& result) {
  std::sort(result.contacts.begin(), result.contacts.end(),
            [](const DistributedContact& x, const DistributedContact& y) {
              const auto x_fibers = std::tie(x.fiber_a, x.fiber_b);
              const auto y_fibers = std::tie(y.fiber_a, y.fiber_b);
              return x_fibers < y_fibers || (x_fibers == y_fibers && is_closer(x, y));
            });
  std::optional<Place> last;
  keep_if(
      [&](const DistributedContact& contact) {
        const Place place = place_of(contact);
        const bool is_first = !last || !are_of_same_fibers(*last, place);
        last = place;
        return is_first;
      },
      result);

  const auto size = static_cast<std::size_t>(ranks.size());
  PerRank<Place> places(size);
  for (const DistributedContact& contact : result.contacts) {
    places[home_of(contact, size)].push_back(place_of(contact));
  }
  places = ranks.exchange(std::move(places));
  std::vector<Place> all;
  for (const std::vector<Place>& some : places) {
    all.insert(all.end(), some.begin(), some.end());
  }
  std::sort(all.begin(), all.end(), [](const Place& x, const Place& y) {
    const auto x_fibers = std::tie(x.a.fiber, x.b.fiber);
    const auto y_fibers = std::tie(y.a.fiber, y.b.fiber);
    return x_fibers < y_fibers || (x_fibers == y_fibers && x < y);
  });
  all.erase(std::unique(all.begin(), all.end(), are_of_same_fibers), all.end());

  PerRank<std::uint8_t> is_closest(size);
  for (std::size_t other = 0; other < size; ++other) {
    for (const Place& place : places[other]) {
      const auto closest =
          std::lower_bound(all.begin(), all.end(), place, [](const Place& x, const Place& y) {
            return std::tie(x.a.fiber, x.b.fiber) < std::tie(y.a.fiber, y.b.fiber);
          });
      is_closest[other].push_back(closest->key() == place.key() ? 1 : 0);
    }
  }
  is_closest = ranks.exchange(std::move(is_closest));
  std::vector<std::size_t> next(size, 0);
  keep_if(
      [&](const DistributedContact& contact) {
        const std::size_t home = home_of(contact, size);
        return is_closest[home][next[home]++] != 0;
      },
      result);
}

}  // namespace fiber
