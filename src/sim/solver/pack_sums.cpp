// Compiled once per instruction set; Highway chooses among them at run time.
#include "src/sim/solver/pack_sums.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/solver/pack_sums.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void sum_squares(SumSize size, const SimdBatch* inertias, const SimdBatch* positions,
                 const SimdBatch* predicted, SimdBatch& sum) {
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    Real squares = real(0.0);
    for (std::size_t i = 0; i < size.count; ++i) {
      const Real change = load(positions[i], lane) - load(predicted[i], lane);
      squares = squares + load(inertias[i], lane) * change * change;
    }
    store(squares, sum, lane);
  }
}

void inertia(SumSize size, double factor, const SimdBatch* inertias, const SimdBatch* positions,
             const SimdBatch* predicted, SimdBatch* gradient, SimdBatch* hessian,
             std::size_t height) {
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    for (std::size_t i = 0; i < size.count; ++i) {
      const Real scaled = load(inertias[i], lane) * real(factor);
      const Real change = load(positions[i], lane) - load(predicted[i], lane);
      store(scaled * change, gradient[i], lane);
      store(scaled, hessian[i * height], lane);
    }
  }
}

void sum_products(SumSize size, const SimdBatch* a, const SimdBatch* b, SimdBatch& sum) {
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    Real products = real(0.0);
    for (std::size_t i = 0; i < size.count; ++i) {
      products = products + load(a[i], lane) * load(b[i], lane);
    }
    store(products, sum, lane);
  }
}

void move(SumSize size, const SimdBatch* from, const SimdBatch* step, const SimdBatch& shares,
          SimdBatch* positions) {
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    const Real share = load(shares, lane);
    const auto is_moving = hn::Ne(share.value, real(0.0).value);
    for (std::size_t i = 0; i < size.count; ++i) {
      const Real way = share * load(step[i], lane);
      const Real moved = {hn::IfThenElseZero(is_moving, way.value)};
      store(load(from[i], lane) + moved, positions[i], lane);
    }
  }
}

void residual_squares(SumSize size, std::size_t unknowns, const SimdBatch* gradient,
                      const SimdBatch* scales, SimdBatch* squares) {
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    for (std::size_t node = 0; node < size.count; ++node) {
      const std::size_t first = node * unknowns;
      Real sum = real(0.0);
      for (std::size_t k = 0; k < 3; ++k) {
        const Real part = load(gradient[first + k], lane) * load(scales[first + k], lane);
        sum = sum + part * part;
      }
      if (unknowns == 4) {
        const Real turn = load(gradient[first + 3], lane) * load(scales[first + 3], lane);
        sum = larger(sum, turn * turn);
      }
      store(sum, squares[node], lane);
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(sum_squares);
HWY_EXPORT(inertia);
HWY_EXPORT(sum_products);
HWY_EXPORT(move);
HWY_EXPORT(residual_squares);

SimdBatch weighted_squares(SumSize size, const SimdBatch* inertias, const SimdBatch* positions,
                           const SimdBatch* predicted) {
  SimdBatch sum;
  HWY_DYNAMIC_DISPATCH(sum_squares)(size, inertias, positions, predicted, sum);
  return sum;
}

void set_inertia(SumSize size, double factor, const SimdBatch* inertias, const SimdBatch* positions,
                 const SimdBatch* predicted, SimdBatch* gradient, SimdBatch* hessian,
                 std::size_t height) {
  HWY_DYNAMIC_DISPATCH(inertia)
  (size, factor, inertias, positions, predicted, gradient, hessian, height);
}

SimdBatch products(SumSize size, const SimdBatch* a, const SimdBatch* b) {
  SimdBatch sum;
  HWY_DYNAMIC_DISPATCH(sum_products)(size, a, b, sum);
  return sum;
}

void move_by(SumSize size, const SimdBatch* from, const SimdBatch* step, const SimdBatch& shares,
             SimdBatch* positions) {
  HWY_DYNAMIC_DISPATCH(move)(size, from, step, shares, positions);
}

void squared_residuals(SumSize size, std::size_t unknowns, const SimdBatch* gradient,
                       const SimdBatch* scales, SimdBatch* squares) {
  HWY_DYNAMIC_DISPATCH(residual_squares)(size, unknowns, gradient, scales, squares);
}

}  // namespace fiber
#endif
