#include "fiber_proximity/query/contact_accumulator.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "src/bounds/bounding_volume.hpp"

namespace fiber {
namespace {

std::size_t capacity_of(const QueryOptions& options, const QueryLimits& limits) {
  switch (options.type) {
    case QueryType::CLOSEST:
      return 1;
    case QueryType::LIMITED:
      return limits.contacts;
    case QueryType::FIRST:
    case QueryType::ALL:
    case QueryType::FIBER_PAIRS:
      break;
  }
  return 0;
}

}  // namespace

ContactAccumulator::ContactAccumulator(const QueryOptions& options, QueryResult& result)
    : limits_(options),
      pairs_left_(limits_.pairs),
      minima_(result),
      options_(options),
      result_(result),
      capacity_(capacity_of(options, limits_)) {
  result_.contacts.clear();
  result_.limit_reached = false;
  result_.others_lower = std::numeric_limits<double>::infinity();
  set_bound(options.margin);
}

double ContactAccumulator::bound_of(std::uint32_t fiber_a, std::uint32_t fiber_b) {
  if (options_.type != QueryType::FIBER_PAIRS) {
    return bound_;
  }
  const Contact* best = minima_.find(fiber_a, fiber_b);
  return best == nullptr ? bound_ : best->distance - slack(best->distance);
}

void ContactAccumulator::keep(const Contact& contact) {
  if (options_.type == QueryType::FIBER_PAIRS) {
    keep_of_fibers(contact);
  } else if (capacity_ != 0) {
    keep_if_closest(contact);
  } else {
    result_.contacts.push_back(contact);
    done_ = options_.type == QueryType::FIRST;
    stay_within_limit();
  }
}

void ContactAccumulator::keep_of_fibers(const Contact& contact) {
  const Contact* best = minima_.find(contact.fiber_a, contact.fiber_b);
  if (best != nullptr) {
    leave_out(contact.closer_than(*best) ? best->lower : contact.lower);
  }
  minima_.keep(contact);
  stay_within_limit();
}

/// Contacts beyond the limit of them go, but not one by one; what is farther than those that stay
/// does not matter any more.
void ContactAccumulator::stay_within_limit() {
  std::vector<Contact>& contacts = result_.contacts;
  if (contacts.size() < limits_.most_kept) {
    return;
  }
  keep_closest(limits_.contacts, result_);
  result_.limit_reached = true;
  if (options_.type == QueryType::FIBER_PAIRS) {
    minima_.contacts_have_moved();
  }
  set_bound(std::min(bound_, contacts.back().distance));
}

/// The contacts are a heap with the farthest of the k closest on top.
void ContactAccumulator::keep_if_closest(const Contact& contact) {
  std::vector<Contact>& contacts = result_.contacts;
  if (contacts.size() == capacity_) {
    if (!contact.closer_than(contacts.front())) {
      leave_out(contact.lower);
      return;
    }
    std::pop_heap(contacts.begin(), contacts.end(), closer);
    leave_out(contacts.back().lower);
    contacts.pop_back();
  }
  contacts.push_back(contact);
  std::push_heap(contacts.begin(), contacts.end(), closer);
  if (contacts.size() == capacity_) {
    set_bound(contacts.front().distance - slack(contacts.front().distance));
  }
}

/// [m] By how much less than this distance a pair must be closer to be looked for: the same for
/// distances and depths.
double ContactAccumulator::slack(double distance) const {
  const double relative = options_.relative_tolerance;
  return std::max(options_.tolerance, std::abs(distance) * (relative / (1.0 + relative)));
}

void ContactAccumulator::leave_out(double lower) {
  result_.others_lower = std::min(result_.others_lower, lower);
}

/// What is found is sorted at the end, which must be over by then.
void ContactAccumulator::look_at_deadline() {
  constexpr double seconds_to_sort_one = 4e-7;
  const double needed = seconds_to_sort_one * static_cast<double>(result_.contacts.size());
  if (!done_ && limits_.deadline.has_passed(1.0, needed)) {
    end_early();
  }
}

void ContactAccumulator::end_early() {
  done_ = true;
  result_.complete = false;
}

void ContactAccumulator::reach_pair_limit() {
  end_early();
  result_.limit_reached = true;
}

void ContactAccumulator::finish(double least_gap) {
  std::vector<Contact>& contacts = result_.contacts;
  // Pairs that were not found are beyond the bound, unless it ended early.
  leave_out(done_ ? least_gap : bound_);
  const bool more = keep_closest(limits_.contacts, result_);
  if (more || (options_.type == QueryType::LIMITED && contacts.size() == capacity_)) {
    result_.limit_reached = true;
  }
  sort_by_key(contacts);
}

void ContactAccumulator::set_bound(double bound) {
  bound_ = bound;
  // Capsules that penetrate have volumes that overlap: those know no negative margin.
  rounded_bound_ = round_up(std::max(bound, 0.0));
}

}  // namespace fiber
