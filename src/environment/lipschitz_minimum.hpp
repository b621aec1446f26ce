#pragma once

#include <algorithm>
#include <cmath>
#include <queue>

#include "fiber_proximity/environment/axis_distance.hpp"

namespace fiber {

/// Least signed distance along a segment when nothing is known of it but that it changes by no more
/// than the length between two points (S. A. Piyavskii 1972, "An algorithm for finding the absolute
/// extremum of a function"). Ends when it is known to a sixteenth of itself or of the segment's
/// length, whichever is more; `lower` is certain.
/// @param function AxisDistance of a parameter s
/// @param length   [m] of the segment
/// @param start    the distance at one point of it
template <class Function>
AxisDistance lipschitz_minimum(const Function& function, double length, const AxisDistance& start) {
  struct Interval {
    Interval(double low, double high, double at_low, double at_high, double segment_length)
        : begin(low),
          end(high),
          begin_value(at_low),
          end_value(at_high),
          lower(0.5 * (at_low + at_high - segment_length * (high - low))) {}
    bool operator<(const Interval& other) const { return lower > other.lower; }

    double begin, end;
    double begin_value, end_value;  // [m]
    double lower;                   // [m] no value between is less
  };
  constexpr double tolerance = 1.0 / 16.0;
  AxisDistance best = start;
  const auto look = [&](double s) {
    AxisDistance found = function(s);
    found.s = s;
    if (found.distance < best.distance) {
      best = found;
    }
    return found.distance;
  };
  std::priority_queue<Interval> intervals;
  const double begin_value = look(0.0);
  const double end_value = look(1.0);
  intervals.emplace(0.0, 1.0, begin_value, end_value, length);
  for (;;) {
    const Interval lowest = intervals.top();
    const double middle = 0.5 * (lowest.begin + lowest.end);
    const double enough = tolerance * std::max(std::abs(best.distance), length);
    if (best.distance - lowest.lower <= enough || !(lowest.begin < middle && middle < lowest.end)) {
      best.lower = std::min(best.distance, lowest.lower);
      return best;
    }
    intervals.pop();
    const double value = look(middle);
    intervals.emplace(lowest.begin, middle, lowest.begin_value, value, length);
    intervals.emplace(middle, lowest.end, value, lowest.end_value, length);
  }
}

}  // namespace fiber
