#include "src/mpi/kth_smallest.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fiber {

std::optional<PairKey> kth_smallest(const Communicator& ranks, std::uint64_t count,
                                    std::vector<PairKey> places) {
  if (ranks.sum(places.size()) < count) {
    return std::nullopt;
  }
  // Ranks pass theirs on in pairs, and each keeps no more than it is asked for.
  std::sort(places.begin(), places.end());
  places.resize(std::min<std::uint64_t>(count, places.size()));
  const auto rank = static_cast<std::size_t>(ranks.rank());
  const auto size = static_cast<std::size_t>(ranks.size());
  for (std::size_t step = 1; step < size; step *= 2) {
    PerRank<PairKey> to(size);
    if (rank % (2 * step) == step) {
      to[rank - step] = std::exchange(places, {});
    }
    for (const std::vector<PairKey>& more : ranks.exchange(std::move(to))) {
      std::vector<PairKey> merged;
      merged.reserve(places.size() + more.size());
      std::merge(places.begin(), places.end(), more.begin(), more.end(),
                 std::back_inserter(merged));
      places = std::move(merged);
    }
    places.resize(std::min<std::uint64_t>(count, places.size()));
  }
  return ranks.broadcast(rank == 0 ? places.back() : PairKey());
}

}  // namespace fiber
