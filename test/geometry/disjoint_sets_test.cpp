#include "src/geometry/disjoint_sets.hpp"

#include <gtest/gtest.h>

#include <algorithm>

#include "test/support/random.hpp"

namespace fiber::test {
namespace {

TEST(DisjointSets, AreWhatWasJoined) {
  SCOPED_TRACE(seed_message());
  Random random;
  for (int round = 0; round < 100; ++round) {
    const auto count = static_cast<std::uint32_t>(random.integer(1, 20));
    const auto draw = [&] {
      return static_cast<std::uint32_t>(random.integer(0, static_cast<int>(count) - 1));
    };
    DisjointSets sets(count);
    std::vector<std::uint32_t> expected(count);
    std::iota(expected.begin(), expected.end(), 0U);
    std::vector<std::uint32_t> roots;
    for (std::uint32_t joins = draw(); joins > 0; --joins) {
      const std::uint32_t a = draw();
      const std::uint32_t b = draw();
      sets.join(a, b);
      const std::uint32_t least = std::min(expected[a], expected[b]);
      const std::uint32_t other = std::max(expected[a], expected[b]);
      std::replace(expected.begin(), expected.end(), other, least);
      sets.find_roots(roots);
      ASSERT_EQ(roots, expected) << "round " << round;
    }
  }
}

TEST(DisjointSets, AreAloneAfterReset) {
  DisjointSets sets(3);
  sets.join(2, 0);
  sets.reset(4);
  std::vector<std::uint32_t> roots;
  sets.find_roots(roots);
  EXPECT_EQ(roots, (std::vector<std::uint32_t>{0, 1, 2, 3}));
}

/// As chains joined from their far end are: the longest paths there can be.
TEST(DisjointSets, OfAMillionInAChainAreFoundAtOnce) {
  constexpr std::uint32_t count = 1'000'000;
  DisjointSets sets(count);
  for (std::uint32_t i = count - 1; i > 0; --i) {
    sets.join(i, i - 1);
  }
  std::vector<std::uint32_t> roots;
  sets.find_roots(roots);
  EXPECT_EQ(roots, std::vector<std::uint32_t>(count, 0U));
}

}  // namespace
}  // namespace fiber::test
