#include "fiber_proximity/query/contact_judge.hpp"

#include <algorithm>

#include "fiber_proximity/hierarchy/sort_keys.hpp"
#include "src/query/for_each_of.hpp"

namespace fiber {
namespace {

constexpr std::size_t pairs_per_slice = 512;
// Pairs are judged in rounds, so that their distances stay in the cache until they are reported.
constexpr std::size_t slices_per_round = 32;

}  // namespace

void ContactJudge::judge(const PairTest& test, double bound, std::vector<Contact>& contacts) {
  sort_keys(keys_, scratch_);
  constexpr std::size_t pairs_per_round = slices_per_round * pairs_per_slice;
  distances_.resize(std::max(distances_.size(), std::min(pairs_per_round, keys_.size())));
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < keys_.size(); begin += pairs_per_round) {
    count = judge_round(begin, test, bound, contacts, count);
  }
  contacts.resize(count);
}

/// Judges the pairs from `begin` on; returns how many contacts there are now.
std::size_t ContactJudge::judge_round(std::size_t begin, const PairTest& test, double bound,
                                      std::vector<Contact>& contacts, std::size_t contact_count) {
  const std::size_t end = std::min(keys_.size(), begin + slices_per_round * pairs_per_slice);
  const std::size_t slices = (end - begin + pairs_per_slice - 1) / pairs_per_slice;
  const auto slice_begin = [&](std::size_t slice) {
    return std::min(end, begin + slice * pairs_per_slice);
  };
  places_.assign(slices + 1, 0);
  for_each_of(slices, [&](std::size_t slice) {
    const std::size_t first = slice_begin(slice);
    const std::size_t size = slice_begin(slice + 1) - first;
    PairDistance* const distances = distances_.data() + (first - begin);
    PointPair pairs[pairs_per_slice];
    std::transform(keys_.begin() + first, keys_.begin() + first + size, pairs, pair_of);
    test.distances(pairs, size, distances);
    places_[slice + 1] = std::count_if(distances, distances + size,
                                       [&](const PairDistance& each) { return each.gap <= bound; });
  });
  places_[0] = contact_count;
  for (std::size_t slice = 0; slice < slices; ++slice) {
    places_[slice + 1] += places_[slice];
  }
  // What a query before has left there is written over: making it anew would take as long.
  contacts.resize(std::max(contacts.size(), places_[slices]));
  for_each_of(slices, [&](std::size_t slice) {
    std::size_t place = places_[slice];
    for (std::size_t i = slice_begin(slice); i < slice_begin(slice + 1); ++i) {
      const PairDistance& distance = distances_[i - begin];
      if (distance.gap <= bound) {
        contacts[place++] = test.contact(pair_of(keys_[i]), distance);
      }
    }
  });
  return places_[slices];
}

}  // namespace fiber
