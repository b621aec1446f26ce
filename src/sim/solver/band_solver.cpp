// Compiled once per instruction set; Highway chooses among them at run time.
#include "src/sim/solver/band_solver.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/solver/band_solver.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

// The half-bandwidth W is known when compiling, so that the loops over it unroll.

template <std::size_t W>
void factorise_width(std::size_t used, std::size_t size, SimdBatch* hessian) {
  const Real zero = real(0.0);
  const Real one = real(1.0);
  const Real most = real(std::numeric_limits<double>::max());
  for (std::size_t lane = 0; lane < used; lane += lanes_at_once()) {
    SimdBatch* column = hessian;
    for (std::size_t c = 0; c < size; ++c, column += W + 1) {
      const Real pivot = load(column[0], lane);
      const auto is_positive = hn::Gt(pivot.value, zero.value);
      const Real inverse = one / Real{hn::IfThenElse(is_positive, pivot.value, most.value)};
      Real entries[W + 1];
      for (std::size_t j = 1; j <= W; ++j) {
        entries[j] = load(column[j], lane);
      }
      store(inverse, column[0], lane);
      for (std::size_t j = 1; j <= W; ++j) {
        SimdBatch* const later = column + j * (W + 1);
        const Real factor = entries[j] * inverse;
        store(factor, column[j], lane);
        for (std::size_t i = j; i <= W; ++i) {
          store(load(later[i - j], lane) - entries[i] * factor, later[i - j], lane);
        }
      }
    }
  }
}

template <std::size_t W>
void solve_width(std::size_t used, std::size_t size, const SimdBatch* hessian, SimdBatch* values) {
  for (std::size_t lane = 0; lane < used; lane += lanes_at_once()) {
    const SimdBatch* column = hessian;
    Real next[W + 1];  // the values of this row and the ones after it, as far as known
    for (std::size_t j = 0; j < W; ++j) {
      next[j] = load(values[j], lane);
    }
    for (std::size_t c = 0; c < size; ++c, column += W + 1) {
      next[W] = load(values[c + W], lane);
      const Real value = next[0];
      store(value * load(column[0], lane), values[c], lane);
      for (std::size_t j = 1; j <= W; ++j) {
        next[j - 1] = next[j] - load(column[j], lane) * value;
      }
    }
    for (std::size_t j = 0; j < W; ++j) {
      next[j] = real(0.0);  // the values of the rows after this one
    }
    for (std::size_t c = size; c-- > 0;) {
      column -= W + 1;
      Real value = load(values[c], lane);
      for (std::size_t j = W; j > 0; --j) {
        value = value - load(column[j], lane) * next[j - 1];
      }
      store(value, values[c], lane);
      for (std::size_t j = W; j-- > 1;) {
        next[j] = next[j - 1];
      }
      next[0] = value;
    }
  }
}

void factorise(PackSystem& system) {
  system.unknowns == 3
      ? factorise_width<half_bandwidth(3)>(system.used, system.size(), system.hessian.data())
      : factorise_width<half_bandwidth(4)>(system.used, system.size(), system.hessian.data());
}

void solve(const PackSystem& system, SimdBatch* values) {
  system.unknowns == 3
      ? solve_width<half_bandwidth(3)>(system.used, system.size(), system.hessian.data(), values)
      : solve_width<half_bandwidth(4)>(system.used, system.size(), system.hessian.data(), values);
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(factorise);
HWY_EXPORT(solve);

void factorise_band(PackSystem& system) { HWY_DYNAMIC_DISPATCH(factorise)(system); }

void solve_band(const PackSystem& system, SimdBatch* values) {
  HWY_DYNAMIC_DISPATCH(solve)(system, values);
}

}  // namespace fiber
#endif
