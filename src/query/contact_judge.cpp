#include "fiber_proximity/query/contact_judge.hpp"

#include <algorithm>
#include <limits>

#include "src/query/for_each_of.hpp"

namespace fiber {
namespace {

constexpr std::size_t pairs_per_slice = 512;
// Pairs are judged in rounds, so that their distances stay in the cache until they are reported.
constexpr std::size_t slices_per_round = 32;

// Contacts are written down after that.
constexpr double part_to_judge = 0.9;

}  // namespace

void ContactJudge::judge(const std::vector<std::uint64_t>& keys, const PairTest& test,
                         const QueryLimits& limits, QueryResult& result) {
  constexpr std::size_t pairs_per_round = slices_per_round * pairs_per_slice;
  const std::size_t most = std::max(distances_.size(), std::min(pairs_per_round, keys.size()));
  distances_.resize(most);
  is_contact_.resize(most);
  contact_count_ = 0;
  bound_ = std::numeric_limits<double>::infinity();
  result.others_lower = test.margin();  // of pairs that are no candidates
  for (std::size_t begin = 0; begin < keys.size(); begin += pairs_per_round) {
    judge_round(keys.data() + begin, std::min(pairs_per_round, keys.size() - begin), test,
                limits.deadline, result);
    if (contact_count_ >= limits.most_kept) {
      leave_closest(limits.contacts, result);
    }
  }
  result.contacts.resize(contact_count_);
  if (contact_count_ > limits.contacts) {
    leave_closest(limits.contacts, result);
  }
  if (result.limit_reached) {
    sort_by_key(result.contacts);
  }
  if (!result.complete) {
    result.others_lower = test.least_gap();
  }
}

/// Of the contacts so far, which are more.
void ContactJudge::leave_closest(std::uint64_t count, QueryResult& result) {
  result.contacts.resize(contact_count_);
  result.limit_reached = keep_closest(count, result);
  contact_count_ = result.contacts.size();
  bound_ = result.contacts.back().upper;
}

void ContactJudge::judge_round(const std::uint64_t* keys, std::size_t count, const PairTest& test,
                               const Deadline& deadline, QueryResult& result) {
  slices_.assign((count + pairs_per_slice - 1) / pairs_per_slice, Slice());
  for_each_of(slices_.size(), [&](std::size_t index) {
    Slice& slice = slices_[index];
    slice.begin = index * pairs_per_slice;
    slice.end = std::min(count, slice.begin + pairs_per_slice);
    slice.complete = !deadline.has_passed(part_to_judge);
    if (slice.complete) {
      judge_slice(keys, test, slice);
    }
  });
  for (Slice& slice : slices_) {
    slice.place = contact_count_;
    contact_count_ += slice.contact_count;
    result.others_lower = std::min(result.others_lower, slice.others_lower);
    result.complete = result.complete && slice.complete;
  }
  // What a query before has left there is written over: making it anew would take as long.
  std::vector<Contact>& contacts = result.contacts;
  contacts.resize(std::max(contacts.size(), contact_count_));
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

void ContactJudge::judge_slice(const std::uint64_t* keys, const PairTest& test, Slice& slice) {
  PointPair pairs[pairs_per_slice];
  PairDistance* const distances = distances_.data() + slice.begin;
  const std::size_t size = slice.end - slice.begin;
  std::transform(keys + slice.begin, keys + slice.end, pairs, pair_of);
  test.distances(pairs, size, distances);
  slice.others_lower = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < size; ++i) {
    const bool is_near = test.gap_lower(pairs[i], distances[i]) <= bound_ &&
                         test.is_within_margin(pairs[i], distances[i]);
    const bool is_contact = is_near && !test.lacks_loop(pairs[i], distances[i]);
    is_contact_[slice.begin + i] = is_contact ? 1 : 0;
    slice.contact_count += is_contact ? 1 : 0;
    if (!is_near) {
      slice.others_lower = std::min(slice.others_lower, test.gap_lower(pairs[i], distances[i]));
    }
  }
}

}  // namespace fiber
