#include "src/hierarchy/sort_keys.hpp"

#include <hwy/contrib/sort/vqsort.h>
#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_reduce.h>

#include <algorithm>
#include <array>
#include <cstddef>

namespace fiber {
namespace {

constexpr std::size_t chunk_count = 16;
constexpr unsigned bucket_bits = 8;
constexpr std::size_t bucket_count = std::size_t{1} << bucket_bits;
// Below this many keys one thread is faster than several.
constexpr std::size_t worth_splitting = 1U << 15U;

using Places = std::array<std::array<std::size_t, bucket_count>, chunk_count>;

void sort_range(std::uint64_t* keys, std::size_t count) {
  // Highway begins each time with a call of the system, for random bytes: that takes longer.
  constexpr std::size_t few = 32;
  if (count <= few) {
    std::sort(keys, keys + count);
    return;
  }
  thread_local const hwy::Sorter sorter;  // has scratch memory of its own
  sorter(keys, count, hwy::SortAscending());
}

/// Keys by their leading bits, the common ones of all keys left out.
class Buckets {
 public:
  explicit Buckets(const std::vector<std::uint64_t>& keys) {
    const Extremes extremes = tbb::parallel_reduce(
        tbb::blocked_range<std::size_t>(0, keys.size(), worth_splitting),
        Extremes{keys.front(), keys.front()},
        [&](const tbb::blocked_range<std::size_t>& range, Extremes found) {
          for (std::size_t i = range.begin(); i < range.end(); ++i) {
            found = united(found, {keys[i], keys[i]});
          }
          return found;
        },
        united);
    min_ = extremes.least;
    const std::uint64_t range = extremes.largest - extremes.least;
    while ((range >> shift_) >= bucket_count) {
      ++shift_;
    }
  }

  std::size_t of(std::uint64_t key) const { return (key - min_) >> shift_; }

 private:
  struct Extremes {
    std::uint64_t least;
    std::uint64_t largest;
  };

  static Extremes united(const Extremes& a, const Extremes& b) {
    return {std::min(a.least, b.least), std::max(a.largest, b.largest)};
  }

  std::uint64_t min_ = 0;
  unsigned shift_ = 0;
};

/// Where in chunk c the keys of bucket b are to go: behind those of the buckets before, and of the
/// same one in the chunks before. Returns where buckets begin.
std::array<std::size_t, bucket_count + 1> add_up(Places& places) {
  std::array<std::size_t, bucket_count + 1> begins{};
  std::size_t place = 0;
  for (std::size_t bucket = 0; bucket < bucket_count; ++bucket) {
    begins[bucket] = place;
    for (auto& of_chunk : places) {
      const std::size_t count = of_chunk[bucket];
      of_chunk[bucket] = place;
      place += count;
    }
  }
  begins[bucket_count] = place;
  return begins;
}

}  // namespace

void sort_keys(std::vector<std::uint64_t>& keys, std::vector<std::uint64_t>& scratch) {
  if (keys.size() < worth_splitting) {
    sort_range(keys.data(), keys.size());
    return;
  }
  scratch.resize(keys.size());
  const Buckets buckets(keys);
  const auto chunk_begin = [&](std::size_t chunk) { return keys.size() * chunk / chunk_count; };
  Places places{};
  tbb::parallel_for(std::size_t{0}, chunk_count, [&](std::size_t chunk) {
    for (std::size_t i = chunk_begin(chunk); i < chunk_begin(chunk + 1); ++i) {
      ++places[chunk][buckets.of(keys[i])];
    }
  });
  const auto begins = add_up(places);
  tbb::parallel_for(std::size_t{0}, chunk_count, [&](std::size_t chunk) {
    for (std::size_t i = chunk_begin(chunk); i < chunk_begin(chunk + 1); ++i) {
      scratch[places[chunk][buckets.of(keys[i])]++] = keys[i];
    }
  });
  tbb::parallel_for(std::size_t{0}, bucket_count, [&](std::size_t bucket) {
    sort_range(scratch.data() + begins[bucket], begins[bucket + 1] - begins[bucket]);
  });
  keys.swap(scratch);
}

}  // namespace fiber
