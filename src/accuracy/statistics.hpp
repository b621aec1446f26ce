#pragma once

#include <algorithm>
#include <cassert>
#include <chrono>
#include <cmath>
#include <numeric>
#include <vector>

namespace fiber {

/// The value that a share of the values do not exceed (nearest rank): 0.5 for the median.
inline double quantile(std::vector<double> values, double share) {
  assert(!values.empty() && share > 0.0 && share <= 1.0);
  const auto rank =
      static_cast<std::ptrdiff_t>(std::ceil(share * static_cast<double>(values.size()))) - 1;
  std::nth_element(values.begin(), values.begin() + rank, values.end());
  return values[static_cast<std::size_t>(rank)];
}

inline double median(const std::vector<double>& values) { return quantile(values, 0.5); }

inline double mean(const std::vector<double>& values) {
  assert(!values.empty());
  return std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
}

inline double milliseconds(std::chrono::steady_clock::duration duration) {
  return std::chrono::duration<double, std::milli>(duration).count();
}

/// Time a call takes [ms].
template <class Call>
double time_of(const Call& call) {
  const auto start = std::chrono::steady_clock::now();
  call();
  return milliseconds(std::chrono::steady_clock::now() - start);
}

}  // namespace fiber
