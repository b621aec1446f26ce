#include "src/mpi/closest_of_fibers.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <tuple>
#include <utility>

namespace fiber {
namespace {

constexpr double no_gap = std::numeric_limits<double>::infinity();

auto two_fibers_of(const PairKey& key) { return std::tie(key.a.fiber, key.b.fiber); }

}  // namespace

std::size_t ClosestOfFibers::Hash::operator()(const FiberPair& fibers) const {
  constexpr std::uint64_t odd = 0x9e3779b97f4a7c15U;  // spreads neighbouring numbers
  return (fibers.first * odd ^ fibers.second) * odd >> 32U;
}

const FiberPairMinimum* ClosestOfFibers::find(std::uint64_t fiber_a, std::uint64_t fiber_b) {
  const FiberPair pair{fiber_a, fiber_b};
  if (pair != last_ || last_place_ == none) {
    const auto found = places_.find(pair);
    last_ = pair;
    last_place_ = found == places_.end() ? none : found->second;
  }
  return last_place_ == none ? nullptr : &minima_[last_place_];
}

double ClosestOfFibers::keep(const FiberPairMinimum& minimum) {
  const FiberPair pair{minimum.key.a.fiber, minimum.key.b.fiber};
  const FiberPairMinimum* known = find(pair.first, pair.second);
  double lower = no_gap;
  if (known != nullptr) {
    assert(minimum.key < known->key);
    lower = known->is_here ? known->contact.lower : no_gap;
    minima_[last_place_] = minimum;
  } else {
    last_place_ = minima_.size();
    places_.emplace(pair, last_place_);
    minima_.push_back(minimum);
  }
  ++changes_;
  lower_bound();
  return lower;
}

/// Not at each change: looking at all minima is to cost no more than finding them.
void ClosestOfFibers::lower_bound() {
  if (minima_.size() != pair_count_ || changes_ < pair_count_) {
    return;
  }
  changes_ = 0;
  double max_gap = -no_gap;
  for (const FiberPairMinimum& minimum : minima_) {
    max_gap = std::max(max_gap, minimum.key.value);
  }
  bound_ = std::min(bound_, max_gap);
}

double ClosestOfFibers::exchange(const Communicator& ranks, double& others_lower) {
  std::vector<PairKey> places;
  places.reserve(minima_.size());
  for (const FiberPairMinimum& minimum : minima_) {
    places.push_back(minimum.key);
  }
  const std::vector<PairKey> closest = closest_of_all(ranks, places);
  double max_gap = -no_gap;
  std::uint64_t reported = 0;
  for (std::size_t i = 0; i < minima_.size(); ++i) {
    FiberPairMinimum& minimum = minima_[i];
    if (closest[i] < minimum.key) {
      others_lower = minimum.is_here ? std::min(others_lower, minimum.contact.lower) : others_lower;
      minimum.key = closest[i];
      minimum.is_here = false;
      ++changes_;
    }
    max_gap =
        minimum.is_here ? std::max({max_gap, minimum.key.value, minimum.contact.upper}) : max_gap;
    reported += minimum.is_here ? 1 : 0;
  }
  lower_bound();
  // Each pair of segments is one rank's, so each pair of fibres that has any is counted once.
  const bool are_all_known = ranks.sum(reported) == pair_count_;
  max_gap = ranks.max(max_gap);
  bound_ = are_all_known ? std::min(bound_, std::max(0.0, max_gap)) : bound_;
  return are_all_known ? std::min(margin_, std::max(0.0, max_gap)) : margin_;
}

std::uint64_t count_fiber_pairs(const Communicator& ranks, const LocalFibers& own,
                                Pairing pairing) {
  const auto& runs = own.runs();
  const auto starts = std::count_if(runs.begin(), runs.end(),
                                    [](const FiberRun& run) { return run.first.segment == 0; });
  const std::uint64_t fibers = ranks.sum(static_cast<std::uint64_t>(starts));
  if (fibers > std::numeric_limits<std::uint32_t>::max()) {
    return std::numeric_limits<std::uint64_t>::max();  // nobody holds as many
  }
  const std::uint64_t of_two = fibers * (fibers - std::min<std::uint64_t>(1, fibers)) / 2;
  return pairing == Pairing::SAME_FIBER         ? fibers
         : pairing == Pairing::DIFFERENT_FIBERS ? of_two
                                                : of_two + fibers;
}

std::vector<PairKey> ClosestOfFibers::closest_of_all(const Communicator& ranks,
                                                     const std::vector<PairKey>& places) {
  // Each pair of fibres has a rank where its places meet.
  const auto size = static_cast<std::size_t>(ranks.size());
  const auto home_of = [size](const PairKey& key) {
    return Hash()({key.a.fiber, key.b.fiber}) % size;
  };
  PerRank<PairKey> met(size);
  for (const PairKey& key : places) {
    met[home_of(key)].push_back(key);
  }
  met = ranks.exchange(std::move(met));
  std::vector<PairKey> closest = joined(met);
  std::sort(closest.begin(), closest.end(), [](const PairKey& x, const PairKey& y) {
    return two_fibers_of(x) < two_fibers_of(y) || (two_fibers_of(x) == two_fibers_of(y) && x < y);
  });
  closest.erase(std::unique(closest.begin(), closest.end(),
                            [](const PairKey& x, const PairKey& y) {
                              return two_fibers_of(x) == two_fibers_of(y);
                            }),
                closest.end());
  for (std::vector<PairKey>& some : met) {
    for (PairKey& key : some) {
      key = *std::lower_bound(
          closest.begin(), closest.end(), key,
          [](const PairKey& x, const PairKey& y) { return two_fibers_of(x) < two_fibers_of(y); });
    }
  }
  met = ranks.exchange(std::move(met));
  std::vector<std::size_t> next(size, 0);
  std::vector<PairKey> answers;
  answers.reserve(places.size());
  for (const PairKey& key : places) {
    const std::size_t home = home_of(key);
    answers.push_back(met[home][next[home]++]);
  }
  return answers;
}

}  // namespace fiber
