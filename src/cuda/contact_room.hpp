#pragma once

#include <algorithm>
#include <cstddef>

#include "src/cuda/judge_pairs.hpp"

namespace fiber {

/// Memory of contacts, 32 bytes each, and of where those of candidates begin.
template <template <class> class Buffer>
struct ContactRoom {
  Buffer<std::uint32_t> a;
  Buffer<std::uint32_t> b;
  Buffer<double> s;
  Buffer<double> t;
  Buffer<double> distance;
  Buffer<std::uint32_t> candidate_begins;  // by candidate, and one more

  void resize(std::size_t count) {
    a.resize(count);
    b.resize(count);
    s.resize(count);
    t.resize(count);
    distance.resize(count);
  }
  /// How many there is room for.
  std::size_t capacity() const {
    return std::min({a.capacity(), b.capacity(), s.capacity(), t.capacity(), distance.capacity()});
  }
  std::size_t bytes() const {
    return a.bytes() + b.bytes() + s.bytes() + t.bytes() + distance.bytes() +
           candidate_begins.bytes();
  }
  ContactArrays arrays() { return {a.data(), b.data(), s.data(), t.data(), distance.data()}; }
};

}  // namespace fiber
