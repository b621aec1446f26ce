#include "src/hierarchy/sort_keys.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "test/support/random.hpp"

namespace fiber::test {
namespace {

using Keys = std::vector<std::uint64_t>;

/// Different keys, their leading bits as unevenly spread as the exponent says.
Keys random_keys(Random& random, std::size_t count, double unevenness) {
  std::set<std::uint64_t> keys;
  while (keys.size() < count) {
    keys.insert(
        static_cast<std::uint64_t>(0x1p63 * std::pow(random.uniform(0.0, 1.0), unevenness)) +
        keys.size());
  }
  Keys shuffled(keys.begin(), keys.end());
  for (std::size_t i = shuffled.size(); i > 1; --i) {
    std::swap(shuffled[i - 1],
              shuffled[static_cast<std::size_t>(random.integer(0, static_cast<int>(i - 1)))]);
  }
  return shuffled;
}

TEST(SortKeys, SortsAnyNumberOfKeysHoweverTheyAreSpread) {
  SCOPED_TRACE(seed_message());
  Random random;
  Keys scratch;  // kept from sort to sort, as a tree does
  for (const std::size_t count : {0U, 1U, 2U, 100U, 32767U, 32768U, 32769U, 100000U}) {
    for (const double unevenness : {1.0, 20.0}) {
      Keys keys = random_keys(random, count, unevenness);
      Keys expected = keys;
      std::sort(expected.begin(), expected.end());
      sort_keys(keys, scratch);
      EXPECT_EQ(keys, expected) << count << " keys";
    }
  }
}

TEST(SortKeys, SortsKeysThatFillAllBits) {
  Keys keys;
  constexpr std::uint64_t count = 70000;
  for (std::uint64_t i = 0; i < count; ++i) {
    keys.push_back(~std::uint64_t{0} / (count - 1) * (count - 1 - i));
  }
  keys.front() = ~std::uint64_t{0};
  Keys expected(keys.rbegin(), keys.rend());
  Keys scratch;
  sort_keys(keys, scratch);
  EXPECT_EQ(keys, expected);
}

}  // namespace
}  // namespace fiber::test
