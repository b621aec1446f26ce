#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/bounds/bounding_volume.hpp"

namespace fiber {
namespace {

constexpr std::size_t first_slot_count = 64;  // a power of two, as all later ones

/// Fibonacci hashing: the high bits of the product depend on all bits of the fibres.
std::size_t hash(std::uint32_t fiber_a, std::uint32_t fiber_b) {
  const std::uint64_t key = std::uint64_t{fiber_a} << 32U | fiber_b;
  return static_cast<std::size_t>((key * 0x9E37'79B9'7F4A'7C15U) >> 32U);
}

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

const Contact* FiberPairMinima::find(std::uint32_t fiber_a, std::uint32_t fiber_b) {
  if (fiber_a != last_a_ || fiber_b != last_b_) {
    last_ = look_up(fiber_a, fiber_b);
    last_of_whole_ = whole_ != nullptr ? whole_->look_up(fiber_a, fiber_b) : nullptr;
    last_a_ = fiber_a;
    last_b_ = fiber_b;
  }
  return last_ != nullptr ? last_ : last_of_whole_;
}

Contact* FiberPairMinima::look_up(std::uint32_t fiber_a, std::uint32_t fiber_b) const {
  const std::uint32_t entry = contacts_.empty() ? 0 : slots_[slot_of(fiber_a, fiber_b)];
  return entry == 0 ? nullptr : &contacts_[entry - 1];
}

void FiberPairMinima::keep(const Contact& contact) {
  assert(contact.fiber_a == last_a_ && contact.fiber_b == last_b_);
  if (last_ != nullptr) {
    if (contact.closer_than(*last_)) {
      *last_ = contact;
    }
    return;
  }
  if (contacts_.empty() || 2 * contacts_.size() >= slots_.size()) {
    grow();
  }
  assert(contacts_.size() < std::numeric_limits<std::uint32_t>::max());
  contacts_.push_back(contact);
  slots_[slot_of(contact.fiber_a, contact.fiber_b)] = static_cast<std::uint32_t>(contacts_.size());
  last_ = &contacts_.back();
}

/// The slot of this pair of fibres, or the free one it is to have.
std::size_t FiberPairMinima::slot_of(std::uint32_t fiber_a, std::uint32_t fiber_b) const {
  const std::size_t mask = slots_.size() - 1;
  std::size_t slot = hash(fiber_a, fiber_b) & mask;
  while (slots_[slot] != 0) {
    const Contact& contact = contacts_[slots_[slot] - 1];
    if (contact.fiber_a == fiber_a && contact.fiber_b == fiber_b) {
      break;
    }
    slot = (slot + 1) & mask;
  }
  return slot;
}

/// Twice as many slots; the first ones for the first contact, as slots may be left of a query
/// before.
void FiberPairMinima::grow() {
  slots_.resize(contacts_.empty() ? first_slot_count : 2 * slots_.size());
  fill_slots();
}

void FiberPairMinima::contacts_have_moved() {
  fill_slots();
  last_ = look_up(last_a_, last_b_);
}

void FiberPairMinima::fill_slots() {
  std::fill(slots_.begin(), slots_.end(), 0);
  for (std::size_t i = 0; i < contacts_.size(); ++i) {
    slots_[slot_of(contacts_[i].fiber_a, contacts_[i].fiber_b)] = static_cast<std::uint32_t>(i + 1);
  }
}

ContactAccumulator::ContactAccumulator(const QueryOptions& options, QueryResult& result)
    : limits_(options),
      pairs_at_begin_(limits_.pairs),
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

ContactAccumulator::ContactAccumulator(const ContactAccumulator& whole, QueryResult& result)
    : limits_(whole.limits_),
      pairs_at_begin_(whole.pairs_left_),
      pairs_left_(whole.pairs_left_),
      minima_(whole.minima_, result),
      options_(whole.options_),
      result_(result),
      capacity_(whole.capacity_) {
  result_.contacts.clear();
  result_.limit_reached = false;
  result_.complete = true;
  result_.others_lower = std::numeric_limits<double>::infinity();
  result_.counts = {};
  set_bound(whole.bound_);
}

void ContactAccumulator::absorb(const ContactAccumulator& part) {
  assert(part.pairs_taken() <= pairs_left_ && !part.lacks_pairs_);
  pairs_left_ -= part.pairs_taken();
  result_.counts += part.result_.counts;
  result_.limit_reached = result_.limit_reached || part.result_.limit_reached;
  // Pairs that the part has not found are beyond its bound.
  leave_out(std::min(part.result_.others_lower, part.bound_));
  if (!part.result_.complete) {
    end_early();
  }
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
  if (contacts.size() < limits_.max_kept) {
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

/// Contacts are sorted at the end, which must be over by then.
void ContactAccumulator::check_deadline() {
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
  lacks_pairs_ = true;
  end_early();
  result_.limit_reached = true;
}

void ContactAccumulator::finish(double min_gap) {
  std::vector<Contact>& contacts = result_.contacts;
  // Pairs that were not found are beyond the bound, unless it ended early.
  leave_out(done_ ? min_gap : bound_);
  const bool more = keep_closest(limits_.contacts, result_);
  if (more || (options_.type == QueryType::LIMITED && contacts.size() == capacity_)) {
    result_.limit_reached = true;
  }
  sort_by_key(contacts);
}

void ContactAccumulator::set_bound(double bound) {
  bound_ = bound;
  rounded_bound_ = round_up(bound);
}

}  // namespace fiber
