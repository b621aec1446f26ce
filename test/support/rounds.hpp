#pragma once

#include <algorithm>
#include <cstddef>
#include <vector>

#include "test/support/random.hpp"

namespace fiber::test {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
/// Sanitizers make tests ten times slower and find in one round what they would find in many: what
/// rounds are for, rare numbers, is for the tests without them.
constexpr int rounds_less = 20;
#else
constexpr int rounds_less = 1;
#endif

/// The rounds that a test goes which should go `count`; at least 1.
constexpr int rounds(int count) { return (count + rounds_less - 1) / rounds_less; }

/// Those of them to test with: all, or every few from a random one on; at least one of those there
/// are.
template <class Element>
std::vector<Element> sampled(const std::vector<Element>& all, Random& random) {
  std::vector<Element> some;
  const int last_first = std::clamp(static_cast<int>(all.size()), 1, rounds_less) - 1;
  for (auto i = static_cast<std::size_t>(random.integer(0, last_first)); i < all.size();
       i += rounds_less) {
    some.push_back(all[i]);
  }
  return some;
}

}  // namespace fiber::test
