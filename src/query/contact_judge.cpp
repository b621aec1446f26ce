#include "fiber_proximity/query/contact_judge.hpp"

#include <algorithm>

#include "src/query/for_each_of.hpp"

namespace fiber {
namespace {

constexpr std::size_t pairs_per_slice = 512;
// Pairs are judged in rounds, so that their distances stay in the cache until they are reported.
constexpr std::size_t slices_per_round = 32;

}  // namespace

void ContactJudge::judge(const std::vector<std::uint64_t>& keys, const PairTest& test, double bound,
                         std::vector<Contact>& contacts) {
  constexpr std::size_t pairs_per_round = slices_per_round * pairs_per_slice;
  distances_.resize(std::max(distances_.size(), std::min(pairs_per_round, keys.size())));
  std::size_t count = 0;
  for (std::size_t begin = 0; begin < keys.size(); begin += pairs_per_round) {
    count = judge_round(keys.data() + begin, std::min(pairs_per_round, keys.size() - begin), test,
                        bound, contacts, count);
  }
  contacts.resize(count);
}

/// Judges `count` pairs; returns how many contacts there are now.
std::size_t ContactJudge::judge_round(const std::uint64_t* keys, std::size_t count,
                                      const PairTest& test, double bound,
                                      std::vector<Contact>& contacts, std::size_t contact_count) {
  const std::size_t slices = (count + pairs_per_slice - 1) / pairs_per_slice;
  const auto slice_begin = [&](std::size_t slice) {
    return std::min(count, slice * pairs_per_slice);
  };
  places_.assign(slices + 1, 0);
  for_each_of(slices, [&](std::size_t slice) {
    const std::size_t begin = slice_begin(slice);
    const std::size_t size = slice_begin(slice + 1) - begin;
    PairDistance* const distances = distances_.data() + begin;
    PointPair pairs[pairs_per_slice];
    std::transform(keys + begin, keys + begin + size, pairs, pair_of);
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
      if (distances_[i].gap <= bound) {
        contacts[place++] = test.contact(pair_of(keys[i]), distances_[i]);
      }
    }
  });
  return places_[slices];
}

}  // namespace fiber
