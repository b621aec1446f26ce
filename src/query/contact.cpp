#include "fiber_proximity/query/contact.hpp"

#include <algorithm>
#include <cstdint>
#include <numeric>
#include <tuple>

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "fiber_proximity/query/options.hpp"

namespace fiber {
namespace {

/// Keeps the closest one of each pair of fibres only.
void keep_closest_of_fibers(QueryResult& result) {
  std::vector<Contact>& contacts = result.contacts;
  std::sort(contacts.begin(), contacts.end(), [](const Contact& x, const Contact& y) {
    const auto x_fibers = std::tie(x.fiber_a, x.fiber_b);
    const auto y_fibers = std::tie(y.fiber_a, y.fiber_b);
    return x_fibers < y_fibers || (x_fibers == y_fibers && x.closer_than(y));
  });
  std::size_t kept = 0;
  for (const Contact& contact : contacts) {
    if (kept > 0 && contacts[kept - 1].fiber_a == contact.fiber_a &&
        contacts[kept - 1].fiber_b == contact.fiber_b) {
      result.others_lower = std::min(result.others_lower, contact.lower);
    } else {
      contacts[kept++] = contact;
    }
  }
  contacts.resize(kept);
}

}  // namespace

void sort_by_key(std::vector<Contact>& contacts) {
  std::sort(contacts.begin(), contacts.end(), by_key);
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

void merge_results(const QueryOptions& options, const QueryResult& more, QueryResult& result) {
  std::vector<Contact>& contacts = result.contacts;
  contacts.insert(contacts.end(), more.contacts.begin(), more.contacts.end());
  result.others_lower = std::min(result.others_lower, more.others_lower);
  result.complete = result.complete && more.complete;
  result.counts += more.counts;
  result.limit_reached = result.limit_reached || more.limit_reached;
  const QueryLimits limits(options);
  switch (options.type) {
    case QueryType::FIRST:
    case QueryType::CLOSEST:
      keep_closest(1, result);
      break;
    case QueryType::LIMITED:
      keep_closest(limits.contacts, result);
      result.limit_reached = result.limit_reached || contacts.size() == limits.contacts;
      break;
    case QueryType::FIBER_PAIRS:
      keep_closest_of_fibers(result);
      [[fallthrough]];
    case QueryType::ALL:
      result.limit_reached = keep_closest(limits.contacts, result) || result.limit_reached;
      break;
  }
  sort_by_key(contacts);
}

}  // namespace fiber
