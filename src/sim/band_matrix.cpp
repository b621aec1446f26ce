#include "fiber_proximity/sim/band_matrix.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <limits>

namespace fiber {
namespace {

// The half-bandwidth W is known when compiling, so that the loops over it unroll. Columns beyond
// the last are there and zero, so that factorising need not stop early.

/// Leaves the inverses of the pivots on the diagonal: solving multiplies by them.
template <std::size_t W>
bool factorise_band(double* column, std::size_t size) {
  bool is_definite = true;
  for (std::size_t c = 0; c < size; ++c, column += W + 1) {
    if (!(column[0] > 0.0)) {
      column[0] = std::numeric_limits<double>::max();
      is_definite = false;
    }
    const double inverse = 1.0 / column[0];
    for (std::size_t j = 1; j <= W; ++j) {
      double* const later = column + j * (W + 1);
      const double factor = column[j] * inverse;
      for (std::size_t i = j; i <= W; ++i) {
        later[i - j] -= column[i] * factor;
      }
    }
    column[0] = inverse;
    for (std::size_t j = 1; j <= W; ++j) {
      column[j] *= inverse;
    }
  }
  return is_definite;
}

/// Of the last columns fewer than W entries are below the diagonal and in the matrix. Each value
/// waits for the one found just before it: what depends on that comes last.
template <std::size_t W>
void solve_band(const double* entries, std::size_t size, double* values) {
  const std::size_t full = size > W ? size - W : 0;  // columns
  const double* column = entries;
  std::array<double, W + 1> next{};  // values of this row and the W after it, as far as known
  for (std::size_t j = 0; j < std::min(W, size); ++j) {
    next[j] = values[j];
  }
  for (std::size_t c = 0; c < full; ++c, column += W + 1) {
    next[W] = values[c + W];
    const double value = next[0];
    values[c] = value * column[0];
    for (std::size_t j = 1; j <= W; ++j) {
      next[j - 1] = next[j] - column[j] * value;
    }
  }
  for (std::size_t c = full; c < size; ++c, column += W + 1) {
    const double value = next[0];
    values[c] = value * column[0];
    for (std::size_t j = 1; j < size - c; ++j) {
      next[j - 1] = next[j] - column[j] * value;
    }
  }
  for (std::size_t c = size; c-- > full;) {
    column -= W + 1;
    for (std::size_t j = size - c; j-- > 1;) {
      values[c] -= column[j] * values[c + j];
    }
  }
  for (std::size_t c = full; c-- > 0;) {
    column -= W + 1;
    double value = values[c];
    for (std::size_t j = W; j > 0; --j) {
      value -= column[j] * values[c + j];
    }
    values[c] = value;
  }
}

}  // namespace

BandMatrix::BandMatrix(std::size_t size, std::size_t half_bandwidth)
    : size_(size),
      half_bandwidth_(half_bandwidth),
      entries_(size > 0 ? (size + half_bandwidth) * (half_bandwidth + 1) : 0) {
  assert(half_bandwidth == without_twist || half_bandwidth == with_twist);
}

void BandMatrix::set_zero() { std::fill(entries_.begin(), entries_.end(), 0.0); }

void BandMatrix::decouple(std::size_t index) {
  assert(index < size_);
  fiber::decouple(index, half_bandwidth_, 1, entries_.data());
}

void decouple(std::size_t index, std::size_t half_bandwidth, std::size_t stride, double* entries) {
  const std::size_t height = half_bandwidth + 1;
  double* const column = entries + index * height * stride;
  column[0] = 1.0;
  for (std::size_t j = 1; j <= half_bandwidth; ++j) {
    column[j * stride] = 0.0;
    if (j <= index) {
      entries[((index - j) * height + j) * stride] = 0.0;
    }
  }
}

bool BandMatrix::factorise() {
  return half_bandwidth_ == without_twist ? factorise_band<without_twist>(entries_.data(), size_)
                                          : factorise_band<with_twist>(entries_.data(), size_);
}

void BandMatrix::solve(double* values) const {
  if (half_bandwidth_ == without_twist) {
    solve_band<without_twist>(entries_.data(), size_, values);
  } else {
    solve_band<with_twist>(entries_.data(), size_, values);
  }
}

}  // namespace fiber
