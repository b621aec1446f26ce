#include "fiber_proximity/query/contact.hpp"

#include <algorithm>
#include <numeric>

namespace fiber {

void sort_by_key(std::vector<Contact>& contacts) {
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& x, const Contact& y) { return x.key() < y.key(); });
}

void sort_by_distance(std::vector<Contact>& contacts) {
  std::sort(contacts.begin(), contacts.end(), closer);
}

bool keep_closest(std::size_t count, QueryResult& result) {
  std::vector<Contact>& contacts = result.contacts;
  if (contacts.size() <= count) {
    return false;
  }
  const auto end = contacts.begin() + static_cast<std::ptrdiff_t>(count);
  std::nth_element(contacts.begin(), end - 1, contacts.end(), closer);
  result.others_lower =
      std::accumulate(end, contacts.end(), result.others_lower,
                      [](double least, const Contact& x) { return std::min(least, x.lower); });
  contacts.erase(end, contacts.end());
  return true;
}

const Contact* QueryResult::closest() const {
  const auto closest =
      std::min_element(contacts.begin(), contacts.end(),
                       [](const Contact& x, const Contact& y) { return x.distance < y.distance; });
  return closest == contacts.end() ? nullptr : &*closest;
}

double QueryResult::minimum_lower() const {
  return std::accumulate(
      contacts.begin(), contacts.end(), others_lower,
      [](double least, const Contact& contact) { return std::min(least, contact.lower); });
}

}  // namespace fiber
