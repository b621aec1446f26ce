#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber::test {

/// Options of a query for pairs within a margin [m], all else as by default.
inline QueryOptions within(double margin, QueryType type = QueryType::ALL) {
  QueryOptions options;
  options.margin = margin;
  options.type = type;
  return options;
}

inline bool identical(const Contact& x, const Contact& y) {
  return x.key() == y.key() && x.s == y.s && x.t == y.t && x.distance == y.distance &&
         x.point_a == y.point_a && x.point_b == y.point_b && x.normal == y.normal;
}

inline testing::AssertionResult same_contacts(const std::vector<Contact>& found,
                                              const std::vector<Contact>& expected) {
  if (found.size() != expected.size()) {
    return testing::AssertionFailure() << found.size() << " contacts, expected " << expected.size();
  }
  for (std::size_t i = 0; i < found.size(); ++i) {
    if (!identical(found[i], expected[i])) {
      return testing::AssertionFailure()
             << "contact " << i << " is (" << found[i].fiber_a << ", " << found[i].segment_a << ", "
             << found[i].fiber_b << ", " << found[i].segment_b << ") at " << found[i].distance
             << ", expected (" << expected[i].fiber_a << ", " << expected[i].segment_a << ", "
             << expected[i].fiber_b << ", " << expected[i].segment_b << ") at "
             << expected[i].distance;
    }
  }
  return testing::AssertionSuccess();
}

inline bool contains(const std::vector<Contact>& contacts, const Contact& contact) {
  return std::any_of(contacts.begin(), contacts.end(),
                     [&](const Contact& other) { return identical(other, contact); });
}

}  // namespace fiber::test
