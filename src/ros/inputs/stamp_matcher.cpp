#include "src/ros/inputs/stamp_matcher.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdlib>

namespace fiber_proximity_ros {
namespace {

/// A later set is better only if it spans less by this part of the time that it is later.
constexpr double age_penalty = 0.1;

std::int64_t to_nanoseconds(const ros::Time& stamp) {
  return static_cast<std::int64_t>(stamp.toNSec());
}

std::int64_t to_nanoseconds(double seconds) {
  constexpr double max = 4e18;  // beyond all differences of stamps
  return static_cast<std::int64_t>(std::min(std::round(1e9 * seconds), max));
}

}  // namespace

StampMatcher::StampMatcher(std::size_t inputs, double slop, std::size_t queue_size)
    : slop_(to_nanoseconds(slop)), queue_size_(queue_size), queues_(inputs) {}

void StampMatcher::add(std::size_t input, const ros::Time& stamp) {
  Queue& queue = queues_[input];
  if (!queue.takes_part && !queue.is_unmatched) {
    queue.takes_part = true;
    begin_again();
  }
  queue.newest = to_nanoseconds(stamp);
  queue.stamps.push_back(*queue.newest);
  search();
  if (queue.stamps.size() > queue_size_) {
    begin_again();
    queue.stamps.pop_front();
    queue.has_dropped = true;
    search();
  }
  readmit_unmatched();
}

bool StampMatcher::leave_out(std::size_t input) {
  if (!queues_[input].takes_part && !queues_[input].is_unmatched) {
    return false;
  }
  begin_again();
  queues_[input] = Queue();
  search();
  return true;
}

void StampMatcher::leave_out_farthest(const ros::Time& now) {
  Queue* farthest = nullptr;
  Stamp max_distance = -1;
  for (Queue& queue : queues_) {
    const Stamp distance =
        queue.takes_part && queue.newest ? std::abs(*queue.newest - to_nanoseconds(now)) : -1;
    if (distance > max_distance) {
      max_distance = distance;
      farthest = &queue;
    }
  }
  if (farthest != nullptr) {
    farthest->takes_part = false;
    farthest->is_unmatched = true;
    begin_again();
    search();
  }
}

bool StampMatcher::is_waiting() const {
  return std::any_of(queues_.begin(), queues_.end(),
                     [](const Queue& queue) { return queue.takes_part && !queue.stamps.empty(); });
}

void StampMatcher::reset() {
  queues_.assign(queues_.size(), Queue());
  candidate_.reset();
  recent_.clear();
  found_.clear();
}

void StampMatcher::readmit_unmatched() {
  for (Queue& queue : queues_) {
    if (queue.is_unmatched && std::any_of(queue.stamps.begin(), queue.stamps.end(),
                                          [this](Stamp stamp) { return is_near(stamp); })) {
      queue.is_unmatched = false;
      queue.takes_part = true;
      begin_again();
      search();
    }
  }
}

/// True if a stamp could be in a set with one of those that take part.
bool StampMatcher::is_near(Stamp stamp) const {
  const auto near = [this, stamp](Stamp other) { return std::abs(other - stamp) <= slop_; };
  return std::any_of(recent_.begin(), recent_.end(), near) ||
         std::any_of(queues_.begin(), queues_.end(), [&near](const Queue& queue) {
           return queue.takes_part && std::any_of(queue.stamps.begin(), queue.stamps.end(), near);
         });
}

/// Tries the sets of neighbouring stamps in their order, as far as all inputs have been heard.
void StampMatcher::search() {
  while (has_all_heads()) {
    const auto [start, end] =
        boundaries([this](std::size_t i) { return queues_[i].stamps[queues_[i].head]; });
    for (std::size_t i = 0; i < queues_.size(); ++i) {
      queues_[i].has_dropped = queues_[i].has_dropped && i == end.input;
    }
    if (!candidate_) {
      if (end.stamp - start.stamp > slop_ || queues_[end.input].has_dropped) {
        queues_[start.input].stamps.pop_front();
        continue;
      }
      candidate_ = Candidate{end.input, end.stamp, 0, 0};
      make_candidate(start, end);
    } else if (!is_worth_no_more(end.stamp, start.stamp)) {
      make_candidate(start, end);
    }
    ++queues_[start.input].head;
    // All later sets contain what lies between the pivot and this end.
    if (start.input == candidate_->pivot || is_worth_no_more(end.stamp, candidate_->pivot_stamp) ||
        (!has_all_heads() && is_optimal_whatever_comes())) {
      emit();
    }
  }
}

/// Goes on with the search as if what is still to come had the best stamps it can have.
bool StampMatcher::is_optimal_whatever_comes() const {
  std::vector<std::size_t> heads;
  for (const Queue& queue : queues_) {
    heads.push_back(queue.head);
  }
  const auto best_stamp = [&](std::size_t i) {
    const std::deque<Stamp>& stamps = queues_[i].stamps;
    return heads[i] < stamps.size() ? stamps[heads[i]]
                                    : std::max(stamps.back(), candidate_->pivot_stamp);
  };
  while (true) {
    const auto [start, end] = boundaries(best_stamp);
    if (is_worth_no_more(end.stamp, candidate_->pivot_stamp)) {
      return true;
    }
    if (!is_worth_no_more(end.stamp, start.stamp)) {
      return false;
    }
    assert(start.stamp < candidate_->pivot_stamp);  // else one of the two is true
    ++heads[start.input];
  }
}

/// True if a set with this end and this start is no better than the candidate.
bool StampMatcher::is_worth_no_more(Stamp end, Stamp start) const {
  return (1.0 + age_penalty) * static_cast<double>(end - candidate_->end) >=
         static_cast<double>(start - candidate_->start);
}

/// True if each input that takes part, of which there is one at least, has a stamp to be tried.
bool StampMatcher::has_all_heads() const {
  const auto takes_part = [](const Queue& queue) { return queue.takes_part; };
  const auto is_exhausted = [](const Queue& queue) { return queue.is_exhausted(); };
  return std::any_of(queues_.begin(), queues_.end(), takes_part) &&
         std::none_of(queues_.begin(), queues_.end(), is_exhausted);
}

void StampMatcher::begin_again() {
  candidate_.reset();
  for (Queue& queue : queues_) {
    queue.head = 0;
  }
}

/// Makes the heads of the queues the candidate. Earlier stamps belong to no set any more.
void StampMatcher::make_candidate(const Boundary& start, const Boundary& end) {
  candidate_->start = start.stamp;
  candidate_->end = end.stamp;
  for (Queue& queue : queues_) {
    queue.stamps.erase(queue.stamps.begin(),
                       queue.stamps.begin() + static_cast<std::ptrdiff_t>(queue.head));
    queue.head = 0;
  }
}

void StampMatcher::emit() {
  StampSet set(queues_.size());
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    if (queues_[i].takes_part) {
      set[i] = ros::Time().fromNSec(static_cast<std::uint64_t>(queues_[i].stamps.front()));
      queues_[i].stamps.pop_front();
    }
  }
  found_.push_back(std::move(set));
  recent_.push_back(candidate_->end);
  if (recent_.size() > queue_size_) {
    recent_.pop_front();
  }
  begin_again();
}

/// Finds the input with the earliest stamp, the first of equal ones, and the input with the latest,
/// the last of equal ones.
template <class StampOf>
std::pair<StampMatcher::Boundary, StampMatcher::Boundary> StampMatcher::boundaries(
    const StampOf& stamp_of) const {
  std::optional<Boundary> first;
  std::optional<Boundary> last;
  for (std::size_t i = 0; i < queues_.size(); ++i) {
    if (!queues_[i].takes_part) {
      continue;
    }
    const Boundary here{i, stamp_of(i)};
    first = !first || here.stamp < first->stamp ? here : first;
    last = !last || here.stamp >= last->stamp ? here : last;
  }
  return {*first, *last};
}

}  // namespace fiber_proximity_ros
