#pragma once

#include <cstdint>

namespace fiber {

/// Work a query did. The paper's "cage tests", "cage intersections" and "primitive tests".
struct QueryCounts {
  std::uint64_t node_tests = 0;
  std::uint64_t node_overlaps = 0;
  std::uint64_t primitive_tests = 0;

  QueryCounts& operator+=(const QueryCounts& more) {
    node_tests += more.node_tests;
    node_overlaps += more.node_overlaps;
    primitive_tests += more.primitive_tests;
    return *this;
  }
};

}  // namespace fiber
