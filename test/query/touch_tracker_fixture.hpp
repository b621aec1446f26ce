#pragma once

#include <gtest/gtest.h>

#include <chrono>
#include <cstdint>
#include <vector>

#include "src/query/touch_tracker.hpp"

namespace fiber::test {

inline TimeBounds at(std::int64_t lower, std::int64_t upper) {
  return {std::chrono::nanoseconds(lower), std::chrono::nanoseconds(upper)};
}

/// Steps are 1000 ns long, the first ends at 1000.
class TouchTrackerTest : public testing::Test {
 protected:
  struct Segments {
    std::uint32_t a;
    std::uint32_t b;
  };

  /// Pairs of segments of fibres 0 and 1.
  std::vector<TouchEvent> step(const std::vector<Segments>& segments) {
    std::vector<TouchingPair> pairs;
    for (const Segments& pair : segments) {
      pairs.push_back({0, pair.a, 1, pair.b, -1e-3, false, step_, {}});
    }
    return step_with(pairs);
  }

  std::vector<TouchEvent> step_with(const std::vector<TouchingPair>& pairs) {
    std::vector<TouchEvent> events;
    tracker_.advance(pairs, step_, events);
    ids_.clear();
    for (std::size_t i = 0; i < pairs.size(); ++i) {
      ids_.push_back(tracker_.touch_of(i).id);
    }
    step_ = {step_.upper, step_.upper + std::chrono::nanoseconds(1000)};
    return events;
  }

  TouchTracker tracker_;
  TimeBounds step_ = at(0, 1000);
  std::vector<std::uint64_t> ids_;  // of the last step's pairs
};

}  // namespace fiber::test
