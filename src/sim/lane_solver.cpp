// Compiled once per instruction set; Highway chooses among them at run time.
#include "lane_solver.hpp"

#include <limits>

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "src/sim/lane_solver.cpp"
#include <hwy/foreach_target.h>  // must come before highway.h
#include <hwy/highway.h>

#include "src/sim/lanes-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {
namespace {

constexpr std::size_t width = column_height - 1;

void measure(RodLanes& rods) {
  const Real least = real(std::numeric_limits<double>::min());
  const Real one = real(1.0);
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Vector point = load_vector(rods.positions, 0, lane);
    for (std::size_t i = 0; i + 1 < rods.node_count; ++i) {
      const Vector next = load_vector(rods.positions, i + 1, lane);
      const Vector edge = next - point;
      const Real length = larger(square_root(dot(edge, edge)), least);
      const Real inverse = one / length;
      store(length, rods.lengths[i], lane);
      store(inverse, rods.inverse_lengths[i], lane);
      const Vector tangent = inverse * edge;
      for (std::size_t k = 0; k < 3; ++k) {
        store(tangent.of[k], rods.tangents[3 * i + k], lane);
      }
      point = next;
    }
  }
}

void factorise(std::size_t size, Lanes* hessian) {
  const Real zero = real(0.0);
  const Real one = real(1.0);
  const Real most = real(std::numeric_limits<double>::max());
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    Lanes* column = hessian;
    for (std::size_t c = 0; c < size; ++c, column += column_height) {
      const Real pivot = load(column[0], lane);
      const auto is_positive = hn::Gt(pivot.value, zero.value);
      const Real inverse = one / Real{hn::IfThenElse(is_positive, pivot.value, most.value)};
      Real entries[column_height];
      for (std::size_t j = 1; j <= width; ++j) {
        entries[j] = load(column[j], lane);
      }
      store(inverse, column[0], lane);
      for (std::size_t j = 1; j <= width; ++j) {
        Lanes* const later = column + j * column_height;
        const Real factor = entries[j] * inverse;
        store(factor, column[j], lane);
        for (std::size_t i = j; i <= width; ++i) {
          store(load(later[i - j], lane) - entries[i] * factor, later[i - j], lane);
        }
      }
    }
  }
}

void solve(std::size_t size, const Lanes* hessian, Lanes* values) {
  for (std::size_t lane = 0; lane < lane_count; lane += lanes_at_once()) {
    const Lanes* column = hessian;
    Real next[column_height];  // the values of this row and the ones after it, as far as known
    for (std::size_t j = 0; j < width; ++j) {
      next[j] = load(values[j], lane);
    }
    for (std::size_t c = 0; c < size; ++c, column += column_height) {
      next[width] = load(values[c + width], lane);
      const Real value = next[0];
      store(value * load(column[0], lane), values[c], lane);
      for (std::size_t j = 1; j <= width; ++j) {
        next[j - 1] = next[j] - load(column[j], lane) * value;
      }
    }
    for (std::size_t j = 0; j < width; ++j) {
      next[j] = real(0.0);  // the values of the rows after this one
    }
    for (std::size_t c = size; c-- > 0;) {
      column -= column_height;
      Real value = load(values[c], lane);
      for (std::size_t j = width; j > 0; --j) {
        value = value - load(column[j], lane) * next[j - 1];
      }
      store(value, values[c], lane);
      for (std::size_t j = width; j-- > 1;) {
        next[j] = next[j - 1];
      }
      next[0] = value;
    }
  }
}

}  // namespace
}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace fiber {

HWY_EXPORT(measure);
HWY_EXPORT(factorise);
HWY_EXPORT(solve);

void measure_edges(RodLanes& rods) { HWY_DYNAMIC_DISPATCH(measure)(rods); }

void factorise_lanes(std::size_t size, std::vector<Lanes>& hessian) {
  HWY_DYNAMIC_DISPATCH(factorise)(size, hessian.data());
}

void solve_lanes(std::size_t size, const std::vector<Lanes>& hessian, std::vector<Lanes>& values) {
  HWY_DYNAMIC_DISPATCH(solve)(size, hessian.data(), values.data());
}

}  // namespace fiber
#endif
