#include "validation/geometry/time_polynomial.hpp"

#include <algorithm>

namespace fiber {
namespace {

/// The error of all that is computed here, as a part of magnitudes: it takes some hundred
/// operations in 113 bits.
const QuadNumber roundings = 1e-28;

}  // namespace

bool TimePolynomial::is_positive(const QuadNumber& begin, const QuadNumber& end) const {
  std::vector<QuadNumber> shifted = coefficients;  // by powers of (t − begin) / (end − begin)
  const std::size_t size = shifted.size();
  for (std::size_t i = 0; i + 1 < size; ++i) {
    for (std::size_t j = size - 1; j > i; --j) {
      shifted[j - 1] += begin * shifted[j];
    }
  }
  QuadNumber power = 1;
  for (QuadNumber& coefficient : shifted) {
    coefficient *= power;
    power *= end - begin;
  }
  // Differences of what is divided by binomial coefficients, summed up again.
  QuadNumber binomial = 1;
  const auto degree = static_cast<double>(size - 1);
  for (std::size_t i = 0; i < size; ++i) {
    shifted[i] /= binomial;
    binomial *=
        QuadNumber(degree - static_cast<double>(i)) / QuadNumber(static_cast<double>(i) + 1.0);
  }
  for (std::size_t i = 1; i < size; ++i) {
    for (std::size_t j = size - 1; j >= i; --j) {
      shifted[j] += shifted[j - 1];
    }
  }
  const QuadNumber error = roundings * magnitude;
  return std::all_of(shifted.begin(), shifted.end(),
                     [&](const QuadNumber& coefficient) { return coefficient > error; });
}

TimePolynomial operator+(const TimePolynomial& a, const TimePolynomial& b) {
  const bool is_shorter = a.coefficients.size() < b.coefficients.size();
  const TimePolynomial& shorter = is_shorter ? a : b;
  TimePolynomial sum = is_shorter ? b : a;
  for (std::size_t i = 0; i < shorter.coefficients.size(); ++i) {
    sum.coefficients[i] += shorter.coefficients[i];
  }
  sum.magnitude += shorter.magnitude;
  return sum;
}

TimePolynomial operator-(TimePolynomial a) {
  for (QuadNumber& coefficient : a.coefficients) {
    coefficient = -coefficient;
  }
  return a;
}
TimePolynomial operator-(const TimePolynomial& a, const TimePolynomial& b) { return a + -b; }

TimePolynomial operator*(const TimePolynomial& a, const TimePolynomial& b) {
  TimePolynomial product(std::vector<QuadNumber>(a.coefficients.size() + b.coefficients.size() - 1),
                         a.magnitude * b.magnitude);
  for (std::size_t i = 0; i < a.coefficients.size(); ++i) {
    for (std::size_t j = 0; j < b.coefficients.size(); ++j) {
      product.coefficients[i + j] += a.coefficients[i] * b.coefficients[j];
    }
  }
  return product;
}

}  // namespace fiber
