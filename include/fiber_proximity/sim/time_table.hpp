#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace fiber {

/// A quantity as a function of time: constant, or a table of times and values with straight lines
/// between them. After its last entry it keeps that entry's value, or begins again.
/// @tparam Value numbers or vectors
template <class Value>
class TimeTable {
 public:
  /// A value at a time.
  struct Entry {
    double time;  ///< [s]
    Value value;
  };

  /// The same value at all times.
  explicit TimeTable(const Value& constant) : entries_{{0.0, constant}} {}

  /// @param entries     at least one; their times rise from 0
  /// @param is_periodic whether it begins again at its last time
  /// @throws std::invalid_argument naming the entry and its time
  TimeTable(std::vector<Entry> entries, bool is_periodic) : entries_(std::move(entries)) {
    validate();
    period_ = is_periodic ? entries_.back().time : 0.0;
  }

  /// @param time [s] at least 0
  Value at(double time) const {
    const double wrapped = period_ > 0.0 ? std::fmod(time, period_) : time;
    const auto later = std::find_if(entries_.begin(), entries_.end(),
                                    [wrapped](const Entry& each) { return each.time > wrapped; });
    if (later == entries_.end()) {
      return entries_.back().value;
    }
    if (later == entries_.begin()) {
      return later->value;
    }
    const Entry& from = *std::prev(later);
    const double share = (wrapped - from.time) / (later->time - from.time);
    return from.value + share * (later->value - from.value);
  }

  bool is_constant() const { return entries_.size() == 1; }

  const std::vector<Entry>& entries() const { return entries_; }

 private:
  void validate() const {
    if (entries_.empty()) {
      throw std::invalid_argument("a table of times has no entry, it must have at least one");
    }
    for (std::size_t i = 0; i < entries_.size(); ++i) {
      const double time = entries_[i].time;
      if (!(i == 0 ? time == 0.0 : std::isfinite(time) && time > entries_[i - 1].time)) {
        throw std::invalid_argument("entry " + std::to_string(i) + " of a table has the time " +
                                    std::to_string(time) +
                                    " s, times must be finite and rise from 0");
      }
    }
  }

  std::vector<Entry> entries_;
  double period_ = 0.0;  // [s]; 0: it does not begin again
};

}  // namespace fiber
