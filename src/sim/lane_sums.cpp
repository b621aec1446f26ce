// Compiled once per instruction set; Highway chooses among them at run time.
#include "lane_sums.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/lane_sums.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void sum_squares(std::size_t count, const Lanes* inertias, const Lanes* positions,
                 const Lanes* predicted, Lanes& sum) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Real squares = real(0.0);
    for (std::size_t i = 0; i < count; ++i) {
      const Real change = load(positions[i], lane) - load(predicted[i], lane);
      squares = squares + load(inertias[i], lane) * change * change;
    }
    store(squares, sum, lane);
  }
}

void inertia(std::size_t count, double factor, const Lanes* inertias, const Lanes* positions,
             const Lanes* predicted, Lanes* gradient, Lanes* hessian, std::size_t height) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    for (std::size_t i = 0; i < count; ++i) {
      const Real scaled = load(inertias[i], lane) * real(factor);
      const Real change = load(positions[i], lane) - load(predicted[i], lane);
      store(scaled * change, gradient[i], lane);
      store(scaled, hessian[i * height], lane);
    }
  }
}

void sum_products(std::size_t count, const Lanes* a, const Lanes* b, Lanes& sum) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Real products = real(0.0);
    for (std::size_t i = 0; i < count; ++i) {
      products = products + load(a[i], lane) * load(b[i], lane);
    }
    store(products, sum, lane);
  }
}

void move(std::size_t count, const Lanes* from, const Lanes* step, const Lanes& shares,
          Lanes* positions) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Real share = load(shares, lane);
    const auto is_moving = hn::Ne(share.value, real(0.0).value);
    for (std::size_t i = 0; i < count; ++i) {
      const Real way = share * load(step[i], lane);
      const Real moved = {hn::IfThenElseZero(is_moving, way.value)};
      store(load(from[i], lane) + moved, positions[i], lane);
    }
  }
}

void weigh_step(std::size_t count, const Lanes* gradient, const Lanes* step, StepWeight& weight) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Real decrease = real(0.0);
    Real longest = real(0.0);
    for (std::size_t i = 0; i < count; ++i) {
      const Real component = load(step[i], lane);
      decrease = decrease - load(gradient[i], lane) * component;
      longest = larger(longest, Real{hn::Abs(component.value)});
    }
    store(decrease, weight.decrease, lane);
    store(longest, weight.longest, lane);
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
HWY_EXPORT(weigh_step);

Lanes weighted_squares(std::size_t count, const Lanes* inertias, const Lanes* positions,
                       const Lanes* predicted) {
  Lanes sum;
  HWY_DYNAMIC_DISPATCH(sum_squares)(count, inertias, positions, predicted, sum);
  return sum;
}

void set_inertia(std::size_t count, double factor, const Lanes* inertias, const Lanes* positions,
                 const Lanes* predicted, Lanes* gradient, Lanes* hessian, std::size_t height) {
  HWY_DYNAMIC_DISPATCH(inertia)
  (count, factor, inertias, positions, predicted, gradient, hessian, height);
}

Lanes products(std::size_t count, const Lanes* a, const Lanes* b) {
  Lanes sum;
  HWY_DYNAMIC_DISPATCH(sum_products)(count, a, b, sum);
  return sum;
}

void move_by(std::size_t count, const Lanes* from, const Lanes* step, const Lanes& shares,
             Lanes* positions) {
  HWY_DYNAMIC_DISPATCH(move)(count, from, step, shares, positions);
}

StepWeight weigh(std::size_t count, const Lanes* gradient, const Lanes* step) {
  StepWeight weight;
  HWY_DYNAMIC_DISPATCH(weigh_step)(count, gradient, step, weight);
  return weight;
}

}  // namespace fiber
#endif
