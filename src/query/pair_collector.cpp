#include "fiber_proximity/query/for_engines/pair_collector.hpp"

#include <limits>

#include "src/hierarchy/pair_bound.hpp"

namespace fiber {

std::uint32_t PairCollector::FiberFinder::fiber_of(std::uint32_t point) {
  if (point - begin_ >= end_ - begin_) {
    fiber_ = fibers_.segment_id(point).fiber;
    begin_ = fibers_.offsets()[fiber_];
    end_ = fibers_.offsets()[fiber_ + 1];
  }
  return fiber_;
}

PairCollector::PairCollector(const FiberAssembly& fibers, const QueryOptions& options,
                             QueryResult& result, const LoopTest* loops)
    : accumulator_(options, result),
      own_test_(std::in_place, fibers, options, loops),
      test_(*own_test_),
      fibers_a_(fibers),
      fibers_b_(fibers),
      options_(options),
      counts_(result.counts) {}

PairCollector::PairCollector(const FiberAssembly& shape, const FiberAssembly& fibers,
                             const QueryOptions& options, QueryResult& result)
    : accumulator_(options, result),
      own_test_(std::in_place, shape, fibers, options),
      test_(*own_test_),
      fibers_a_(shape),
      fibers_b_(fibers),
      options_(options),
      counts_(result.counts) {}

PairCollector::PairCollector(const PairCollector& whole, QueryResult& result)
    : accumulator_(whole.accumulator_, result),
      test_(whole.test_),
      fibers_a_(whole.fibers_a_),
      fibers_b_(whole.fibers_b_),
      options_(whole.options_),
      counts_(result.counts),
      key_bound_(whole.key_bound_) {}

void PairCollector::absorb(const PairCollector& part) {
  for (const Contact& contact : part.accumulator_.contacts()) {
    accumulator_.keep(contact);
    look_at_depth();
  }
  accumulator_.absorb(part.accumulator_);
}

void PairCollector::offer(std::uint32_t point_a, std::uint32_t point_b) {
  if (!accumulator_.takes_pair()) {
    return;
  }
  const PointPair pair = test_.ordered({point_a, point_b});
  if (pair_key(pair) >= key_bound_ || test_.is_left_out(pair)) {
    return;
  }
  if (options_.type == QueryType::FIBER_PAIRS) {
    offer_of_fibers(pair);
    return;
  }
  // Near pairs that make no loop would be measured in vain, as they do not lower the bound.
  if (accumulator_.lowers_bound() && test_.rules_out(pair.a, pair.b)) {
    return;
  }
  if (const std::optional<Contact> contact = contact_within(pair, accumulator_.bound())) {
    accumulator_.keep(*contact);
    look_at_depth();
  }
}

/// No pair is deeper than both segments are thick. Where those that are kept are as deep, only
/// pairs of smaller indices can take their place, and with a tolerance none need.
void PairCollector::look_at_depth() {
  const Contact* const farthest = accumulator_.farthest();
  if (farthest == nullptr || accumulator_.bound() > test_.min_computed_gap()) {
    return;
  }
  if (accumulator_.bound() < test_.min_computed_gap()) {
    accumulator_.stop();
  } else if (farthest->distance <= test_.min_computed_gap()) {
    key_bound_ = pair_key({fibers_a_.first_point_of(farthest->fiber_a, farthest->segment_a),
                           fibers_b_.first_point_of(farthest->fiber_b, farthest->segment_b)});
  }
}

void PairCollector::finish() {
  if (key_bound_ != PairBound::no_key) {
    accumulator_.leave_out(test_.min_gap());
  }
  accumulator_.finish(test_.min_gap());
}

void PairCollector::offer_of_fibers(PointPair pair) {
  const double bound =
      accumulator_.bound_of(fibers_a_.fiber_of(pair.a), fibers_b_.fiber_of(pair.b));
  if (test_.gap_lower_bound(pair) > bound) {
    accumulator_.leave_out(bound);
    return;
  }
  if (const std::optional<Contact> contact = contact_within(pair, bound)) {
    accumulator_.keep(*contact);
  }
}

/// The contact of a pair that is within the margin and, if the bound [m] is less, within that by
/// the distance that is reported.
std::optional<Contact> PairCollector::contact_within(PointPair pair, double bound) {
  ++counts_.primitive_tests;
  const PairDistance distance = test_.distance(pair);
  const double lower = test_.gap_lower(pair, distance);
  if (lower <= bound && test_.is_within_margin(pair, distance)) {
    std::uint64_t loop_steps = 0;
    const bool lacks_loop = test_.lacks_loop(pair, distance, loop_steps);
    accumulator_.count_loop_steps(loop_steps);
    if (lacks_loop) {
      return std::nullopt;
    }
    const Contact contact = test_.contact(pair, distance);
    if (bound >= options_.margin || contact.distance <= bound) {
      return contact;
    }
  }
  accumulator_.leave_out(lower);
  return std::nullopt;
}

}  // namespace fiber
