#pragma once

#include <algorithm>
#include <cstdint>
#include <tuple>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "test/support/assemblies.hpp"
#include "test/support/exact_gap.hpp"

namespace fiber::test {

using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

/// A pair of segments that is no pair of neighbours.
struct Pair {
  Key key;
  Gap gap;
};

inline std::vector<Pair> all_pairs(const FiberAssembly& fibers) {
  const std::vector<std::uint32_t> segments = segments_of(fibers);
  std::vector<Pair> pairs;
  for (const std::uint32_t a : segments) {
    for (const std::uint32_t b : segments) {
      const SegmentId id_a = fibers.segment_id(a);
      const SegmentId id_b = fibers.segment_id(b);
      if (a < b && (id_a.fiber != id_b.fiber || b - a > 1)) {
        pairs.push_back({{id_a.fiber, id_a.segment, id_b.fiber, id_b.segment},
                         Gap(fibers.capsule(a), fibers.capsule(b))});
      }
    }
  }
  return pairs;
}

inline const Contact* find(const std::vector<Contact>& contacts, const Key& key) {
  const auto found =
      std::lower_bound(contacts.begin(), contacts.end(), key,
                       [](const Contact& each, const Key& wanted) { return each.key() < wanted; });
  return found == contacts.end() || found->key() != key ? nullptr : &*found;
}

}  // namespace fiber::test
