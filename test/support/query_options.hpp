#pragma once

#include <limits>

#include "fiber_proximity/query/options.hpp"
#include "test/support/neighbour_skips.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// Options of any value, but for those that let engines differ: tolerances, the deadline and the
/// limit of pairs. Of the margins some are such that a part of all pairs is within.
/// @param size [m] of the scene
inline QueryOptions random_options(Random& random, double size) {
  QueryOptions options;
  // All are named: an option that is new does not compile before it is drawn here, or left.
  auto& [margin, max_contacts, pairing, neighbour_skip, neighbour_skip_length, deadline,
         contact_limit, pair_limit] = static_cast<PairOptions&>(options);
  const double margins[] = {0.0, 1e-3 * size, size * random.uniform(0.0, 0.1), size,
                            std::numeric_limits<double>::infinity()};
  margin = margins[random.integer(0, 4)];
  max_contacts = static_cast<std::uint32_t>(random.integer(1, 20));
  pairing = random.chance(0.5) ? Pairing::ALL : static_cast<Pairing>(random.integer(1, 2));
  contact_limit = random.chance(0.2) ? static_cast<std::uint32_t>(random.integer(1, 50)) : 0;
  set_neighbour_skips(options, random, 3, random.chance(0.3) ? 0.2 * size : 0.0);
  options.type = static_cast<QueryType>(random.integer(0, 4));
  options.kernel = random.chance(0.2) ? Kernel::EXACT : Kernel::ROBUST;
  return options;
}

/// The same of one type.
inline QueryOptions random_options(Random& random, double size, QueryType type) {
  QueryOptions options = random_options(random, size);
  options.type = type;
  return options;
}

/// Such options, but for one of those that tell which pairs are meant.
inline QueryOptions with_one_drawn_anew(const QueryOptions& options, Random& random, double size) {
  const QueryOptions drawn = random_options(random, size);
  QueryOptions changed = options;
  switch (random.integer(0, 3)) {
    case 0:
      changed.margin = drawn.margin;
      break;
    case 1:
      changed.pairing = drawn.pairing;
      break;
    case 2:
      changed.neighbour_skip = drawn.neighbour_skip;
      break;
    default:
      changed.neighbour_skip_length = drawn.neighbour_skip_length;
      break;
  }
  return changed;
}

}  // namespace fiber::test
