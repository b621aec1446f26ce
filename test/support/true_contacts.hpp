#pragma once

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <set>
#include <tuple>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"
#include "test/support/graph_oracle.hpp"
#include "test/support/joined_fibers.hpp"

namespace fiber::test {

using SegmentPair = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

inline SegmentPair pair_in(const SegmentIdPair& pair) {
  return {pair.fiber_a, pair.segment_a, pair.fiber_b, pair.segment_b};
}

/// The contacts that there are, and those that rounding may decide about.
struct TrueContacts {
  std::set<SegmentPair> certain;
  std::set<SegmentPair> possible;  // and those that are certain
};

inline TrueContacts true_contacts(const JoinedFibers& fibers, const QueryOptions& options) {
  const GraphOracle oracle(fibers);
  TrueContacts contacts;
  const std::vector<GraphOracle::Segment>& segments = oracle.segments();
  for (std::size_t i = 0; i < segments.size(); ++i) {
    for (std::size_t j = i + 1; j < segments.size(); ++j) {
      const GraphOracle::Segment& a = segments[i];
      const GraphOracle::Segment& b = segments[j];
      if (oracle.nearest(a, b).distance - (a.radius + b.radius) <= options.margin &&
          !oracle.is_left_out(a, b, options, 1.0 - 1e-9)) {
        const SegmentPair pair{a.fiber, a.index, b.fiber, b.index};
        contacts.possible.insert(pair);
        if (!oracle.is_left_out(a, b, options, 1.0 + 1e-9)) {
          contacts.certain.insert(pair);
        }
      }
    }
  }
  return contacts;
}

inline testing::AssertionResult are_those(const std::vector<Contact>& found,
                                          const TrueContacts& truth) {
  std::set<SegmentPair> pairs;
  for (const Contact& contact : found) {
    pairs.insert(pair_in(contact));
  }
  const auto failure = [](const char* what, const SegmentPair& pair) {
    const auto& [fiber_a, segment_a, fiber_b, segment_b] = pair;
    return testing::AssertionFailure() << what << " fibre " << fiber_a << ", segment " << segment_a
                                       << " and fibre " << fiber_b << ", segment " << segment_b;
  };
  for (const SegmentPair& pair : truth.certain) {
    if (pairs.count(pair) == 0) {
      return failure("missing:", pair);
    }
  }
  for (const SegmentPair& pair : pairs) {
    if (truth.possible.count(pair) == 0) {
      return failure("no contact:", pair);
    }
  }
  return testing::AssertionSuccess();
}

}  // namespace fiber::test
