#include "src/mpi/first_places.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fiber {

std::optional<Place> last_of_first(const Communicator& ranks, std::uint64_t count,
                                   std::vector<Place> places) {
  if (ranks.sum(places.size()) < count) {
    return std::nullopt;
  }
  // Ranks pass theirs on in pairs, and each keeps no more than it is asked for.
  std::sort(places.begin(), places.end());
  places.resize(std::min<std::uint64_t>(count, places.size()));
  const auto rank = static_cast<std::size_t>(ranks.rank());
  const auto size = static_cast<std::size_t>(ranks.size());
  for (std::size_t step = 1; step < size; step *= 2) {
    PerRank<Place> to(size);
    if (rank % (2 * step) == step) {
      to[rank - step] = std::exchange(places, {});
    }
    for (const std::vector<Place>& more : ranks.exchange(std::move(to))) {
      std::vector<Place> merged;
      merged.reserve(places.size() + more.size());
      std::merge(places.begin(), places.end(), more.begin(), more.end(),
                 std::back_inserter(merged));
      places = std::move(merged);
    }
    places.resize(std::min<std::uint64_t>(count, places.size()));
  }
  return ranks.from_first(rank == 0 ? places.back() : Place());
}

}  // namespace fiber
