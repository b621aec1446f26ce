#pragma once

#include <boost/math/tools/toms748_solve.hpp>
#include <cstdint>

namespace fiber {

/// A root of a function that changes its sign between two numbers.
template <class Function>
double root_between(const Function& function, double low, double high) {
  std::uintmax_t iterations = 200;
  const auto bracket = boost::math::tools::toms748_solve(
      function, low, high, boost::math::tools::eps_tolerance<double>(50), iterations);
  return 0.5 * (bracket.first + bracket.second);
}

}  // namespace fiber
