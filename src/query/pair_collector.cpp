#include "fiber_proximity/query/pair_collector.hpp"

#include <algorithm>
#include <utility>

#include "fiber_proximity/bounds/bounding_volume.hpp"

namespace fiber {
namespace {

bool closer(const Contact& x, const Contact& y) { return x.closer_than(y); }

std::size_t capacity_of(const QueryOptions& options) {
  switch (options.type) {
    case QueryType::CLOSEST:
      return 1;
    case QueryType::LIMITED:
      return options.max_contacts;
    case QueryType::FIRST:
    case QueryType::ALL:
    case QueryType::FIBER_PAIRS:
      break;
  }
  return 0;
}

}  // namespace

PairCollector::PairCollector(const FiberAssembly& fibers, const QueryOptions& options,
                             QueryResult& result)
    : PairCollector(PairTest(fibers, options), {fibers, fibers, result}, options, result) {}

PairCollector::PairCollector(const FiberAssembly& shape, const FiberAssembly& fibers,
                             const QueryOptions& options, QueryResult& result)
    : PairCollector(PairTest(shape, fibers, options), {shape, fibers, result}, options, result) {}

PairCollector::PairCollector(PairTest&& test, const FiberPairMinima& minima,
                             const QueryOptions& options, QueryResult& result)
    : test_(std::move(test)),
      minima_(minima),
      options_(options),
      result_(result),
      capacity_(capacity_of(options)) {
  result_.contacts.clear();
  set_bound(options.margin);
}

void PairCollector::offer(std::uint32_t point_a, std::uint32_t point_b) {
  const PointPair pair = test_.ordered({point_a, point_b});
  if (test_.is_neighbour_pair(pair)) {
    return;
  }
  if (options_.type == QueryType::FIBER_PAIRS) {
    offer_to_minima(pair);
    return;
  }
  ++result_.counts.primitive_tests;
  const PairDistance distance = test_.distance(pair);
  if (distance.gap <= bound_) {
    keep(test_.contact(pair, distance));
  }
}

void PairCollector::offer_to_minima(PointPair pair) {
  const Contact* best = minima_.find(pair);
  const double most = best == nullptr ? bound_ : best->distance;
  if (test_.gap_lower_bound(pair) > most) {
    return;
  }
  ++result_.counts.primitive_tests;
  const PairDistance distance = test_.distance(pair);
  if (distance.gap <= most) {
    minima_.keep(test_.contact(pair, distance));
  }
}

void PairCollector::keep(const Contact& contact) {
  std::vector<Contact>& contacts = result_.contacts;
  if (capacity_ == 0) {
    contacts.push_back(contact);
    done_ = options_.type == QueryType::FIRST;
    return;
  }
  // A heap with the farthest of the k closest on top.
  if (contacts.size() == capacity_) {
    if (!closer(contact, contacts.front())) {
      return;
    }
    std::pop_heap(contacts.begin(), contacts.end(), closer);
    contacts.pop_back();
  }
  contacts.push_back(contact);
  std::push_heap(contacts.begin(), contacts.end(), closer);
  if (contacts.size() == capacity_) {
    set_bound(contacts.front().distance);
  }
}

void PairCollector::finish() {
  std::vector<Contact>& contacts = result_.contacts;
  result_.limit_reached =
      options_.type == QueryType::LIMITED && contacts.size() == options_.max_contacts;
  std::sort(contacts.begin(), contacts.end(),
            [](const Contact& x, const Contact& y) { return x.key() < y.key(); });
}

void PairCollector::set_bound(double bound) {
  bound_ = bound;
  // Capsules that penetrate have volumes that overlap: those know no negative margin.
  rounded_bound_ = round_up(std::max(bound, 0.0));
}

}  // namespace fiber
