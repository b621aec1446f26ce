#pragma once

#include <boost/multiprecision/cpp_bin_float.hpp>
#include <utility>
#include <vector>

#include "validation/geometry/reference_vector.hpp"

namespace fiber {

/// 113 bits, and exponents that no power of a double leaves.
using QuadNumber = boost::multiprecision::cpp_bin_float_quad;

/// A polynomial of time, with what its rounding is measured by.
struct TimePolynomial {
  std::vector<QuadNumber> coefficients;  ///< the one of the lowest power first
  QuadNumber magnitude;                  ///< at least that of all that it was computed from

  /// A constant.
  explicit TimePolynomial(const QuadNumber& value) : coefficients{value}, magnitude(abs(value)) {}
  TimePolynomial(std::vector<QuadNumber> all, const QuadNumber& most)
      : coefficients(std::move(all)), magnitude(most) {}
  TimePolynomial() = default;

  /// Whether it surely is positive all through a piece of the time from 0 to 1: the coefficients in
  /// Bernstein's basis of the piece are lower bounds together, and all of them are positive.
  bool is_positive(const QuadNumber& begin, const QuadNumber& end) const;
};

TimePolynomial operator-(TimePolynomial a);
TimePolynomial operator+(const TimePolynomial& a, const TimePolynomial& b);
TimePolynomial operator-(const TimePolynomial& a, const TimePolynomial& b);
TimePolynomial operator*(const TimePolynomial& a, const TimePolynomial& b);

using TimePolynomialVector = reference::Vector<TimePolynomial>;

}  // namespace fiber
