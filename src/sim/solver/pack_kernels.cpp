// Compiled once per instruction set; Highway chooses among them at run time.
#include "src/sim/solver/pack_kernels.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/solver/pack_kernels.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

void measure(RodPack& rods) {
  const Real smallest = real(std::numeric_limits<double>::min());
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    Vector point = position_at(rods, 0, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Vector next = position_at(rods, i + 1, lane);
      const Vector edge = next - point;
      const Real length = hn::Max(hn::Sqrt(dot(edge, edge)), smallest);
      const Real inverse = one / length;
      store(length, rods.lengths[i], lane);
      store(inverse, rods.inverse_lengths[i], lane);
      store(inverse * edge, &rods.tangents[3 * i], lane);
      point = next;
    }
  }
}

HWY_INLINE Vector director_at(const RodPack& rods, std::size_t edge, std::size_t lane) {
  return load_vector(&rods.directors[3 * edge], lane);
}

/// The angle from the director of the edge before a node to that of the edge after it.
HWY_INLINE Real twist_at(const RodPack& rods, std::size_t node, std::size_t lane) {
  const Vector tangent = tangent_at(rods, node, lane);
  const Vector carried =
      transport(director_at(rods, node - 1, lane), tangent_at(rods, node - 1, lane), tangent);
  return signed_angle(carried, director_at(rods, node, lane), tangent);
}

void measure_directors(RodPack& rods) {
  for (std::size_t lane = 0; lane < rods.used; lane += lanes_at_once()) {
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Vector start = load_vector(&rods.start_tangents[3 * i], lane);
      const Vector director = load_vector(&rods.start_directors[3 * i], lane);
      store(transport(director, start, tangent_at(rods, i, lane)), &rods.directors[3 * i], lane);
      if (i > 0) {
        store(twist_at(rods, i, lane), rods.director_twists[i], lane);
      }
    }
  }
}

SimdBatch sum_squares(SumSize size, const SimdBatch* inertias, const SimdBatch* positions,
                      const SimdBatch* predicted) {
  SimdBatch sum;
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    Real squares = real(0.0);
    for (std::size_t i = 0; i < size.count; ++i) {
      const Real change = load(positions[i], lane) - load(predicted[i], lane);
      squares = squares + load(inertias[i], lane) * change * change;
    }
    store(squares, sum, lane);
  }
  return sum;
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

SimdBatch sum_products(SumSize size, const SimdBatch* a, const SimdBatch* b) {
  SimdBatch sum;
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    Real products = real(0.0);
    for (std::size_t i = 0; i < size.count; ++i) {
      products = products + load(a[i], lane) * load(b[i], lane);
    }
    store(products, sum, lane);
  }
  return sum;
}

void move(SumSize size, const SimdBatch* from, const SimdBatch* step, const SimdBatch& shares,
          SimdBatch* positions) {
  for (std::size_t lane = 0; lane < size.used; lane += lanes_at_once()) {
    const Real share = load(shares, lane);
    const auto is_moving = hn::Ne(share, real(0.0));
    for (std::size_t i = 0; i < size.count; ++i) {
      const Real way = hn::IfThenElseZero(is_moving, share * load(step[i], lane));
      store(load(from[i], lane) + way, positions[i], lane);
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
        sum = hn::Max(sum, turn * turn);
      }
      store(sum, squares[node], lane);
    }
  }
}

// The half-bandwidth W is known when compiling, so that the loops over it unroll.

template <std::size_t W>
void factorise_width(std::size_t used, std::size_t size, SimdBatch* hessian) {
  const Real zero = real(0.0);
  const Real one = real(1.0);
  const Real largest = real(std::numeric_limits<double>::max());
  for (std::size_t lane = 0; lane < used; lane += lanes_at_once()) {
    SimdBatch* column = hessian;
    for (std::size_t c = 0; c < size; ++c, column += W + 1) {
      const Real pivot = load(column[0], lane);
      const Real inverse = one / hn::IfThenElse(hn::Gt(pivot, zero), pivot, largest);
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

HWY_EXPORT(measure);
HWY_EXPORT(measure_directors);

void measure_edges(RodPack& rods) {
  HWY_DYNAMIC_DISPATCH(measure)(rods);
  if (rods.unknowns == 4) {
    HWY_DYNAMIC_DISPATCH(measure_directors)(rods);
  }
}

HWY_EXPORT(sum_squares);
HWY_EXPORT(inertia);
HWY_EXPORT(sum_products);
HWY_EXPORT(move);
HWY_EXPORT(residual_squares);

SimdBatch weighted_squares(SumSize size, const SimdBatch* inertias, const SimdBatch* positions,
                           const SimdBatch* predicted) {
  return HWY_DYNAMIC_DISPATCH(sum_squares)(size, inertias, positions, predicted);
}

void set_inertia(SumSize size, double factor, const SimdBatch* inertias, const SimdBatch* positions,
                 const SimdBatch* predicted, SimdBatch* gradient, SimdBatch* hessian,
                 std::size_t height) {
  HWY_DYNAMIC_DISPATCH(inertia)
  (size, factor, inertias, positions, predicted, gradient, hessian, height);
}

SimdBatch dot_products(SumSize size, const SimdBatch* a, const SimdBatch* b) {
  return HWY_DYNAMIC_DISPATCH(sum_products)(size, a, b);
}

void add_scaled(SumSize size, const SimdBatch* from, const SimdBatch* step, const SimdBatch& shares,
                SimdBatch* positions) {
  HWY_DYNAMIC_DISPATCH(move)(size, from, step, shares, positions);
}

void squared_residuals(SumSize size, std::size_t unknowns, const SimdBatch* gradient,
                       const SimdBatch* scales, SimdBatch* squares) {
  HWY_DYNAMIC_DISPATCH(residual_squares)(size, unknowns, gradient, scales, squares);
}

HWY_EXPORT(factorise);
HWY_EXPORT(solve);

void factorise_band(PackSystem& system) { HWY_DYNAMIC_DISPATCH(factorise)(system); }

void solve_band(const PackSystem& system, SimdBatch* values) {
  HWY_DYNAMIC_DISPATCH(solve)(system, values);
}

}  // namespace fiber
#endif
