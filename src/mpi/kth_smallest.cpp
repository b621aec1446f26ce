#include "src/mpi/kth_smallest.hpp"

#include <algorithm>
#include <iterator>
#include <utility>

namespace fiber {

std::optional<PairKey> kth_smallest(const Communicator& ranks, std::uint64_t k,
                                    std::vector<PairKey> keys) {
  if (ranks.sum(keys.size()) < k) {
    return std::nullopt;
  }
  // Ranks pass theirs on in pairs, and each keeps no more than it is asked for.
  const std::uint64_t kept = std::min<std::uint64_t>(k, keys.size());
  std::partial_sort(keys.begin(), keys.begin() + static_cast<std::ptrdiff_t>(kept), keys.end());
  keys.resize(kept);
  const auto rank = static_cast<std::size_t>(ranks.rank());
  const auto size = static_cast<std::size_t>(ranks.size());
  for (std::size_t step = 1; step < size; step *= 2) {
    PerRank<PairKey> to(size);
    if (rank % (2 * step) == step) {
      to[rank - step] = std::exchange(keys, {});
    }
    for (const std::vector<PairKey>& more : ranks.exchange(std::move(to))) {
      std::vector<PairKey> merged;
      merged.reserve(keys.size() + more.size());
      std::merge(keys.begin(), keys.end(), more.begin(), more.end(), std::back_inserter(merged));
      keys = std::move(merged);
    }
    keys.resize(std::min<std::uint64_t>(k, keys.size()));
  }
  return ranks.broadcast(rank == 0 ? keys.back() : PairKey());
}

}  // namespace fiber
