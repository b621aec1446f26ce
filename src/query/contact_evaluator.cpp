#include "src/query/contact_evaluator.hpp"

#include <algorithm>
#include <limits>

#include "src/query/threads.hpp"

namespace fiber {
namespace {

constexpr std::size_t pairs_per_slice = 512;
// Pairs are evaluated in rounds, so that their distances stay in the cache until they are reported.
constexpr std::size_t slices_per_round = 32;
constexpr std::size_t pairs_per_round = slices_per_round * pairs_per_slice;

/// Along fibres, of all candidates together.
std::uint64_t max_loop_steps(const QueryLimits& limits) {
  constexpr std::uint64_t most = std::numeric_limits<std::uint64_t>::max();
  constexpr std::uint64_t per_pair = QueryLimits::loop_steps_per_pair;
  return limits.pairs > most / per_pair ? most : limits.pairs * per_pair;
}

}  // namespace

void ContactEvaluator::evaluate(const std::vector<std::uint64_t>& keys, const NarrowPhase& test,
                                const QueryLimits& limits, QueryResult& result) {
  const std::size_t most = std::max(distances_.size(), std::min(pairs_per_round, keys.size()));
  distances_.resize(most);
  is_contact_.resize(most);
  contact_count_ = 0;
  loop_steps_ = 0;
  took_too_long_ = false;
  bound_ = std::numeric_limits<double>::infinity();
  result.others_lower = test.margin();  // of pairs that are no candidates
  for (std::size_t begin = 0; begin < keys.size() && !took_too_long_; begin += pairs_per_round) {
    const std::size_t end = std::min(keys.size(), begin + pairs_per_round);
    evaluate_round(keys.data() + begin, end - begin, test, limits, result);
    make_room(end, keys.size(), limits, result.contacts);
    report(keys.data() + begin, test, result.contacts);
    if (contact_count_ >= limits.max_kept) {
      leave_closest(limits.contacts, result);
    }
  }
  result.complete = result.complete && !took_too_long_;
  result.limit_reached = result.limit_reached || took_too_long_;
  result.contacts.resize(contact_count_);
  if (contact_count_ > limits.contacts) {
    leave_closest(limits.contacts, result);
  }
  if (result.limit_reached) {
    sort_by_key(result.contacts);
  }
  if (!result.complete) {
    result.others_lower = test.min_gap();
  }
}

/// Keeps so many of the contacts so far, which are more.
void ContactEvaluator::leave_closest(std::uint64_t count, QueryResult& result) {
  result.contacts.resize(contact_count_);
  result.limit_reached = keep_closest(count, result) || result.limit_reached;
  contact_count_ = result.contacts.size();
  bound_ = result.contacts.back().upper;
}

void ContactEvaluator::evaluate_round(const std::uint64_t* keys, std::size_t count,
                                      const NarrowPhase& test, const QueryLimits& limits,
                                      QueryResult& result) {
  slices_.assign((count + pairs_per_slice - 1) / pairs_per_slice, Slice());
  for_each_of(slices_.size(), [&](std::size_t index) {
    Slice& slice = slices_[index];
    slice.begin = index * pairs_per_slice;
    slice.end = std::min(count, slice.begin + pairs_per_slice);
    slice.complete = !limits.deadline.has_passed(part_of_time);
    if (slice.complete) {
      evaluate_slice(keys, test, max_loop_steps(limits) / slices_per_round, slice);
    }
  });
  for (Slice& slice : slices_) {
    slice.place = contact_count_;
    contact_count_ += slice.contact_count;
    loop_steps_ += slice.loop_steps;
    took_too_long_ = took_too_long_ || slice.took_too_long;
    result.others_lower = std::min(result.others_lower, slice.others_lower);
    result.complete = result.complete && slice.complete;
  }
  took_too_long_ = took_too_long_ || loop_steps_ > max_loop_steps(limits);
}

/// For all contacts there will be if the candidates that are left have as many as those evaluated,
/// and some more. A list that grows to twice its size is there twice while it does.
void ContactEvaluator::make_room(std::size_t evaluated, std::size_t candidates,
                                 const QueryLimits& limits, std::vector<Contact>& contacts) const {
  if (contact_count_ > contacts.capacity()) {
    constexpr double more = 1.1;
    constexpr double a_few = 512.0;
    const double rest = static_cast<double>(candidates) / static_cast<double>(evaluated);
    const double expected = a_few + more * rest * static_cast<double>(contact_count_);
    contacts.reserve(
        std::min(static_cast<std::uint64_t>(expected), limits.max_kept + pairs_per_round));
  }
  // Contacts that an earlier query has left there are written over: making them anew would take
  // as long.
  contacts.resize(std::max(contacts.size(), contact_count_));
}

/// The contacts of a round.
void ContactEvaluator::report(const std::uint64_t* keys, const NarrowPhase& test,
                              std::vector<Contact>& contacts) const {
  for_each_of(slices_.size(), [&](std::size_t index) {
    const Slice& slice = slices_[index];
    std::size_t place = slice.place;
    for (std::size_t i = slice.begin; i < slice.end && slice.contact_count > 0; ++i) {
      if (is_contact_[i] != 0) {
        contacts[place++] = test.contact(pair_of(keys[i]), distances_[i]);
      }
    }
  });
}

/// @param loop_steps_left along fibres; where they are used up the rest of the slice is left out
void ContactEvaluator::evaluate_slice(const std::uint64_t* keys, const NarrowPhase& test,
                                      std::uint64_t loop_steps_left, Slice& slice) {
  PointPair pairs[pairs_per_slice];
  PairDistance* const distances = distances_.data() + slice.begin;
  const std::size_t size = slice.end - slice.begin;
  std::transform(keys + slice.begin, keys + slice.end, pairs, pair_of);
  test.distances(pairs, size, distances);
  slice.others_lower = std::numeric_limits<double>::infinity();
  const bool is_bounded = bound_ < std::numeric_limits<double>::infinity();
  std::size_t i = 0;
  for (; i < size && slice.loop_steps <= loop_steps_left; ++i) {
    const bool is_near = test.is_within_margin(pairs[i], distances[i]) &&
                         (!is_bounded || test.gap_lower(pairs[i], distances[i]) <= bound_);
    const bool is_contact = is_near && !test.lacks_loop(pairs[i], distances[i], slice.loop_steps);
    is_contact_[slice.begin + i] = is_contact ? 1 : 0;
    slice.contact_count += is_contact ? 1 : 0;
    if (!is_near) {
      slice.others_lower = std::min(slice.others_lower, test.gap_lower(pairs[i], distances[i]));
    }
  }
  for (; i < size; ++i) {
    is_contact_[slice.begin + i] = 0;
  }
  slice.took_too_long = slice.loop_steps > loop_steps_left;
}

}  // namespace fiber
