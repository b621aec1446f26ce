#pragma once

#include <cassert>
#include <cstdint>
#include <numeric>
#include <utility>
#include <vector>

namespace fiber {

/// Which of a number of elements are together, directly or through others: a disjoint-set forest
/// whose roots are the smallest elements of their sets.
class DisjointSets {
 public:
  DisjointSets() = default;

  /// Each element is alone.
  explicit DisjointSets(std::uint32_t count) { reset(count); }
  void reset(std::uint32_t count) {
    parents_.resize(count);
    std::iota(parents_.begin(), parents_.end(), 0U);
  }

  /// Makes the sets of two elements one.
  void join(std::uint32_t a, std::uint32_t b) {
    a = shortened_root(a);
    b = shortened_root(b);
    if (a > b) {
      std::swap(a, b);
    }
    parents_[b] = a;
  }

  /// @param roots by element: the smallest of its set
  void find_roots(std::vector<std::uint32_t>& roots) const {
    roots = parents_;
    for (std::uint32_t& root : roots) {
      root = roots[root];  // parents are smaller, and done
    }
  }

 private:
  std::uint32_t shortened_root(std::uint32_t element) {
    assert(element < parents_.size());
    while (parents_[element] != element) {
      element = parents_[element] = parents_[parents_[element]];
    }
    return element;
  }

  std::vector<std::uint32_t> parents_;  // never greater than the element
};

}  // namespace fiber
