// Numbers and vectors of rods side by side, in registers. Included once per instruction set, so it
// has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_SIM_SIMD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SIM_SIMD_INL
#undef FIBER_SIM_SIMD_INL
#else
#define FIBER_SIM_SIMD_INL
#endif

#include <hwy/highway.h>

#include <type_traits>

#include "fiber_proximity/sim/pack_system.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes as registers have, at most all: functions below work from one lane on.
using LaneTag = hn::CappedTag<double, lane_count>;

HWY_INLINE std::size_t lanes_at_once() { return hn::Lanes(LaneTag()); }

struct Real {
  hn::Vec<LaneTag> value;
};

HWY_INLINE Real real(double value) { return {hn::Set(LaneTag(), value)}; }
HWY_INLINE Real load(const SimdBatch& from, std::size_t lane) {
  return {hn::Load(LaneTag(), from.of.data() + lane)};
}
HWY_INLINE void store(Real value, SimdBatch& to, std::size_t lane) {
  hn::Store(value.value, LaneTag(), to.of.data() + lane);
}

HWY_INLINE Real operator+(Real a, Real b) { return {hn::Add(a.value, b.value)}; }
HWY_INLINE Real operator-(Real a, Real b) { return {hn::Sub(a.value, b.value)}; }
HWY_INLINE Real operator*(Real a, Real b) { return {hn::Mul(a.value, b.value)}; }
HWY_INLINE Real operator/(Real a, Real b) { return {hn::Div(a.value, b.value)}; }
HWY_INLINE Real negative(Real a) { return {hn::Neg(a.value)}; }
HWY_INLINE Real square_root(Real a) { return {hn::Sqrt(a.value)}; }
HWY_INLINE Real smaller(Real a, Real b) { return {hn::Min(a.value, b.value)}; }
HWY_INLINE Real larger(Real a, Real b) { return {hn::Max(a.value, b.value)}; }

HWY_INLINE void add(Real value, SimdBatch& to, std::size_t lane) {
  store(load(to, lane) + value, to, lane);
}

struct Vector {
  Real of[3];
};

HWY_INLINE Vector load_vector(const SimdBatch* from, std::size_t lane) {
  return {{load(from[0], lane), load(from[1], lane), load(from[2], lane)}};
}
HWY_INLINE Vector position_at(const RodPack& rods, std::size_t node, std::size_t lane) {
  return load_vector(&rods.positions[rods.unknowns * node], lane);
}
HWY_INLINE Vector tangent_at(const RodPack& rods, std::size_t edge, std::size_t lane) {
  return load_vector(&rods.tangents[3 * edge], lane);
}
HWY_INLINE void store(const Vector& v, SimdBatch* to, std::size_t lane) {
  for (std::size_t i = 0; i < 3; ++i) {
    store(v.of[i], to[i], lane);
  }
}
HWY_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {{a.of[0] + b.of[0], a.of[1] + b.of[1], a.of[2] + b.of[2]}};
}
HWY_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {{a.of[0] - b.of[0], a.of[1] - b.of[1], a.of[2] - b.of[2]}};
}
HWY_INLINE Vector negative(const Vector& a) {
  return {{negative(a.of[0]), negative(a.of[1]), negative(a.of[2])}};
}
HWY_INLINE Vector operator*(Real factor, const Vector& a) {
  return {{factor * a.of[0], factor * a.of[1], factor * a.of[2]}};
}
HWY_INLINE Real dot(const Vector& a, const Vector& b) {
  return a.of[0] * b.of[0] + a.of[1] * b.of[1] + a.of[2] * b.of[2];
}

// Derivatives of rods with U unknowns a node, which is known when compiling: where something goes
// takes as long to find as to add.

/// Calls a function with the number of unknowns as a constant.
template <class Function>
HWY_INLINE void with_unknowns(const PackSystem& system, const Function& function) {
  if (system.unknowns == 3) {
    function(std::integral_constant<std::size_t, 3>());
  } else {
    function(std::integral_constant<std::size_t, 4>());
  }
}

template <std::size_t U>
HWY_INLINE void add_gradient(const Vector& v, std::size_t node, std::size_t lane,
                             PackSystem& system) {
  SimdBatch* const first = &system.gradient[U * node];
  for (std::size_t i = 0; i < 3; ++i) {
    add(v.of[i], first[i], lane);
  }
}

/// A block of the Hessian, in registers.
struct Block {
  Real of[3][3];  // row, column
};

/// isotropic I + a bᵀ
HWY_INLINE Block block_of(Real isotropic, const Vector& a, const Vector& b) {
  Block block;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Real product = a.of[r] * b.of[c];
      block.of[r][c] = r == c ? product + isotropic : product;
    }
  }
  return block;
}

template <std::size_t U>
constexpr std::size_t column_height = half_bandwidth(U) + 1;  // with the diagonal

/// Adds the symmetric block of one node.
template <std::size_t U>
HWY_INLINE void add_diagonal(const Block& block, std::size_t node, std::size_t lane,
                             PackSystem& system) {
  for (std::size_t c = 0; c < 3; ++c) {
    SimdBatch* const column = &system.hessian[(U * node + c) * column_height<U>];
    for (std::size_t r = c; r < 3; ++r) {
      add(block.of[r][c], column[r - c], lane);
    }
  }
}

/// Adds the block whose rows are those of a node so many further.
template <std::size_t U>
HWY_INLINE void add_below(const Block& block, std::size_t node, std::size_t further,
                          std::size_t lane, PackSystem& system) {
  for (std::size_t c = 0; c < 3; ++c) {
    SimdBatch* const column = &system.hessian[(U * node + c) * column_height<U>];
    for (std::size_t r = 0; r < 3; ++r) {
      add(block.of[r][c], column[U * further + r - c], lane);
    }
  }
}

/// Adds the derivatives of an energy of one edge, as RodSystem does.
template <std::size_t U>
HWY_INLINE void add_edge(const Vector& gradient, const Block& block, std::size_t edge,
                         std::size_t lane, PackSystem& system) {
  Block minus;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      minus.of[r][c] = negative(block.of[r][c]);
    }
  }
  add_gradient<U>(negative(gradient), edge, lane, system);
  add_gradient<U>(gradient, edge + 1, lane, system);
  add_diagonal<U>(block, edge, lane, system);
  add_diagonal<U>(block, edge + 1, lane, system);
  add_below<U>(minus, edge, 1, lane, system);
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
