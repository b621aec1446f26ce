#pragma once

#include <string>

#include "fiber_proximity/query/options.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// Sets both neighbour skips, or, one time in three, none, so that self-contacts need loops.
inline void set_neighbour_skips(QueryOptions& options, Random& random, int most, double length) {
  options.neighbour_skip.reset();
  options.neighbour_skip_length.reset();
  if (random.chance(2.0 / 3.0)) {
    options.neighbour_skip = static_cast<std::uint32_t>(random.integer(0, most));
    options.neighbour_skip_length = length;
  }
}

inline std::string skips_of(const QueryOptions& options) {
  return options.needs_loops()
             ? std::string("loops")
             : "skips " + std::to_string(options.neighbour_skip.value_or(1)) + " and " +
                   std::to_string(options.neighbour_skip_length.value_or(0.0)) + " m";
}

}  // namespace fiber::test
