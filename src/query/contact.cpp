#include "fiber_proximity/query/contact.hpp"

#include <algorithm>

namespace fiber {

const Contact* QueryResult::closest() const {
  const auto closest =
      std::min_element(contacts.begin(), contacts.end(),
                       [](const Contact& x, const Contact& y) { return x.distance < y.distance; });
  return closest == contacts.end() ? nullptr : &*closest;
}

}  // namespace fiber
