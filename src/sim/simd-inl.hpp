// Numbers, vectors and edges of rods side by side, in registers. Included once per instruction set,
// so it has the guard that Highway asks for instead of #pragma once.
#if defined(FIBER_SIM_SIMD_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SIM_SIMD_INL
#undef FIBER_SIM_SIMD_INL
#else
#define FIBER_SIM_SIMD_INL
#endif

#include <hwy/highway.h>

#include <cmath>
#include <limits>
#include <type_traits>

#include "fiber_proximity/sim/effect.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

/// As many lanes as registers have, at most all. The functions below work on the lanes from one on.
using LaneTag = hn::CappedTag<double, lane_count>;

HWY_INLINE std::size_t lanes_at_once() { return hn::Lanes(LaneTag()); }

/// A number for each lane; sums, products and so on are Highway's.
using Real = hn::Vec<LaneTag>;

HWY_INLINE Real real(double value) { return hn::Set(LaneTag(), value); }
HWY_INLINE Real load(const SimdBatch& from, std::size_t lane) {
  return hn::Load(LaneTag(), from.lanes.data() + lane);
}
HWY_INLINE void store(Real value, SimdBatch& to, std::size_t lane) {
  hn::Store(value, LaneTag(), to.lanes.data() + lane);
}

HWY_INLINE void add(Real value, SimdBatch& to, std::size_t lane) {
  store(load(to, lane) + value, to, lane);
}

struct Vector {
  Real xyz[3];
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
    store(v.xyz[i], to[i], lane);
  }
}
HWY_INLINE Vector operator+(const Vector& a, const Vector& b) {
  return {{a.xyz[0] + b.xyz[0], a.xyz[1] + b.xyz[1], a.xyz[2] + b.xyz[2]}};
}
HWY_INLINE Vector operator-(const Vector& a, const Vector& b) {
  return {{a.xyz[0] - b.xyz[0], a.xyz[1] - b.xyz[1], a.xyz[2] - b.xyz[2]}};
}
HWY_INLINE Vector negative(const Vector& a) {
  return {{hn::Neg(a.xyz[0]), hn::Neg(a.xyz[1]), hn::Neg(a.xyz[2])}};
}
HWY_INLINE Vector operator*(Real factor, const Vector& a) {
  return {{factor * a.xyz[0], factor * a.xyz[1], factor * a.xyz[2]}};
}
HWY_INLINE Real dot(const Vector& a, const Vector& b) {
  return a.xyz[0] * b.xyz[0] + a.xyz[1] * b.xyz[1] + a.xyz[2] * b.xyz[2];
}

// Derivatives of rods with U unknowns a node. U is a constant, because computing a place in the
// matrix takes as long as adding to it.

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
    add(v.xyz[i], first[i], lane);
  }
}

/// A block of the Hessian, in registers.
struct Block {
  Real rows[3][3];  // row, column
};

/// isotropic I + a bᵀ
HWY_INLINE Block block_of(Real isotropic, const Vector& a, const Vector& b) {
  Block block;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Real product = a.xyz[r] * b.xyz[c];
      block.rows[r][c] = r == c ? product + isotropic : product;
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
      add(block.rows[r][c], column[r - c], lane);
    }
  }
}

/// Adds the block whose columns are those of a node, and whose rows those of a later one.
template <std::size_t U>
HWY_INLINE void add_below(const Block& block, std::size_t node, std::size_t further,
                          std::size_t lane, PackSystem& system) {
  for (std::size_t c = 0; c < 3; ++c) {
    SimdBatch* const column = &system.hessian[(U * node + c) * column_height<U>];
    for (std::size_t r = 0; r < 3; ++r) {
      add(block.rows[r][c], column[U * further + r - c], lane);
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
      minus.rows[r][c] = hn::Neg(block.rows[r][c]);
    }
  }
  add_gradient<U>(negative(gradient), edge, lane, system);
  add_gradient<U>(gradient, edge + 1, lane, system);
  add_diagonal<U>(block, edge, lane, system);
  add_diagonal<U>(block, edge + 1, lane, system);
  add_below<U>(minus, edge, 1, lane, system);
}

// Edges, as edges.hpp has them of one rod: how energies of the turn between two of them act on the
// nodes, and their frames.

/// The edges beside a node.
struct TwoEdges {
  Vector before;  // tangents
  Vector after;
  Real inverse_before;  // of lengths
  Real inverse_after;
};

HWY_INLINE TwoEdges edges_beside(const RodPack& rods, std::size_t node, std::size_t lane) {
  return {tangent_at(rods, node - 1, lane), tangent_at(rods, node, lane),
          load(rods.inverse_lengths[node - 1], lane), load(rods.inverse_lengths[node], lane)};
}

/// The gradient by an edge, from that by its tangent.
HWY_INLINE Vector by_edge(const Vector& tangent, Real inverse_length, const Vector& gradient) {
  return inverse_length * (gradient - dot(tangent, gradient) * tangent);
}

/// Adds the gradient of an energy whose gradients by the two tangents are known.
template <std::size_t U>
HWY_INLINE void add_gradient(const TwoEdges& edges, const Vector& by_before, const Vector& by_after,
                             std::size_t node, std::size_t lane, PackSystem& system) {
  const Vector on_before = by_edge(edges.before, edges.inverse_before, by_before);
  const Vector on_after = by_edge(edges.after, edges.inverse_after, by_after);
  add_gradient<U>(negative(on_before), node - 1, lane, system);
  add_gradient<U>(on_before - on_after, node, lane, system);
  add_gradient<U>(on_after, node + 1, lane, system);
}

/// The part of a Hessian that is of the two edges.
struct EdgeBlocks {
  Block first;  // of the edge before
  Block last;   // of the one after
  Block cross;  // its rows are those of the edge after
};

/// Jᵀ J with the derivative J of the turn, times a factor.
HWY_INLINE EdgeBlocks isotropic_blocks(const TwoEdges& edges, Real factor) {
  const Real one = real(1.0);
  const Vector& a = edges.before;
  const Vector& b = edges.after;
  const Real cosine = dot(a, b);
  const Real first_factor = factor * edges.inverse_before * edges.inverse_before;
  const Real last_factor = factor * edges.inverse_after * edges.inverse_after;
  const Real cross_factor = factor * edges.inverse_before * edges.inverse_after;
  EdgeBlocks blocks;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Real aa = r == c ? one - a.xyz[r] * a.xyz[c] : hn::Neg(a.xyz[r] * a.xyz[c]);
      const Real bb = b.xyz[r] * b.xyz[c];
      blocks.first.rows[r][c] = first_factor * aa;
      blocks.last.rows[r][c] = last_factor * (r == c ? one - bb : hn::Neg(bb));
      blocks.cross.rows[r][c] = cross_factor * (aa - bb + b.xyz[r] * (cosine * a.xyz[c]));
    }
  }
  return blocks;
}

/// Adds Jᵀ u uᵀ J, times a factor.
HWY_INLINE void add_along(const TwoEdges& edges, Real factor, const Vector& u, EdgeBlocks& blocks) {
  const Vector before = by_edge(edges.before, edges.inverse_before, u);
  const Vector after = by_edge(edges.after, edges.inverse_after, u);
  for (std::size_t r = 0; r < 3; ++r) {
    const Real scaled_before = factor * before.xyz[r];
    const Real scaled_after = factor * after.xyz[r];
    for (std::size_t c = 0; c < 3; ++c) {
      blocks.first.rows[r][c] = blocks.first.rows[r][c] + scaled_before * before.xyz[c];
      blocks.last.rows[r][c] = blocks.last.rows[r][c] + scaled_after * after.xyz[c];
      blocks.cross.rows[r][c] = blocks.cross.rows[r][c] + scaled_after * before.xyz[c];
    }
  }
}

/// @param node between the edges
template <std::size_t U>
HWY_INLINE void add_hessian(const EdgeBlocks& blocks, std::size_t node, std::size_t lane,
                            PackSystem& system) {
  const auto& [first, last, cross] = blocks;
  Block middle;
  Block below_first;
  Block above_last;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      below_first.rows[r][c] = hn::Neg(first.rows[r][c] + cross.rows[r][c]);
      above_last.rows[r][c] = hn::Neg(last.rows[r][c] + cross.rows[r][c]);
      middle.rows[r][c] = first.rows[r][c] + last.rows[r][c] + cross.rows[r][c] + cross.rows[c][r];
    }
  }
  add_diagonal<U>(first, node - 1, lane, system);
  add_below<U>(below_first, node - 1, 1, lane, system);
  add_below<U>(cross, node - 1, 2, lane, system);
  add_diagonal<U>(middle, node, lane, system);
  add_below<U>(above_last, node, 1, lane, system);
  add_diagonal<U>(last, node + 1, lane, system);
}

HWY_INLINE Vector cross(const Vector& a, const Vector& b) {
  return {{a.xyz[1] * b.xyz[2] - a.xyz[2] * b.xyz[1], a.xyz[2] * b.xyz[0] - a.xyz[0] * b.xyz[2],
           a.xyz[0] * b.xyz[1] - a.xyz[1] * b.xyz[0]}};
}

HWY_INLINE Vector transport(const Vector& v, const Vector& from, const Vector& to) {
  const Real cosine = dot(from, to);
  const Vector sum = from + to;
  const Real beside_opposite = real(0.5) * dot(sum, sum);
  const Vector axis = cross(from, to);
  const Vector turned = cosine * v + cross(axis, v) + dot(axis, v) / beside_opposite * axis;
  const auto stays = hn::Or(hn::Lt(beside_opposite, real(1e-12)),
                            hn::Eq(dot(from, from) * dot(to, to), real(0.0)));
  Vector result;
  for (std::size_t k = 0; k < 3; ++k) {
    result.xyz[k] = hn::IfThenElse(stays, v.xyz[k], turned.xyz[k]);
  }
  return result;
}

HWY_INLINE Vector curvature_binormal(const Vector& before, const Vector& after) {
  constexpr double folded = 1e-3;
  const Real factor = real(2.0) / hn::Max(real(folded), real(1.0) + dot(before, after));
  return factor * cross(before, after);
}

/// The angle in [-pi, pi], to some units of the last digit. Neither Highway nor the standard
/// library has an arctangent that is the same on all processors.
HWY_INLINE Real angle_of(Real cosine, Real sine) {
  const Real one = real(1.0);
  const Real smallest = real(std::numeric_limits<double>::min());
  const Real across = hn::Abs(sine);
  const Real along = hn::Abs(cosine);
  // The tangent of an angle of up to pi/4, and of a quarter of it, whose series is short.
  Real tangent = hn::Min(across, along) / hn::Max(hn::Max(across, along), smallest);
  for (int i = 0; i < 2; ++i) {
    tangent = tangent / (one + hn::Sqrt(one + tangent * tangent));
  }
  const Real square = tangent * tangent;
  Real series = real(0.0);
  for (int power = 21; power > 0; power -= 2) {
    series = real(1.0 / power) - square * series;
  }
  const Real angle = real(4.0) * tangent * series;
  const Real in_quadrant = hn::IfThenElse(hn::Gt(across, along), real(0.5 * M_PI) - angle, angle);
  const auto is_behind = hn::Lt(cosine, real(0.0));
  return hn::CopySignToAbs(hn::IfThenElse(is_behind, real(M_PI) - in_quadrant, in_quadrant), sine);
}

HWY_INLINE Real signed_angle(const Vector& from, const Vector& to, const Vector& about) {
  return angle_of(dot(from, to), dot(about, cross(from, to)));
}

HWY_INLINE Real nearest_turn(Real angle, Real to) {
  const Real turn = real(2.0 * M_PI);
  return angle - turn * hn::Round((angle - to) / turn);
}

HWY_INLINE Real angle_at(const RodPack& rods, std::size_t edge, std::size_t lane) {
  return load(rods.positions[4 * edge + 3], lane);
}

HWY_INLINE Vector director_turn(const RodPack& rods, std::size_t edge, std::size_t lane) {
  const Vector start = load_vector(&rods.start_tangents[3 * edge], lane);
  return real(-0.5) * load(rods.inverse_lengths[edge], lane) *
         curvature_binormal(start, tangent_at(rods, edge, lane));
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
