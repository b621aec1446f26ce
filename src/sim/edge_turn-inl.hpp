// How energies of the turn between two edges act on the nodes, as EdgeTurn has it, for rods side by
// side. Included once per instruction set, as simd-inl.hpp is.
#if defined(FIBER_SIM_EDGE_TURN_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SIM_EDGE_TURN_INL
#undef FIBER_SIM_EDGE_TURN_INL
#else
#define FIBER_SIM_EDGE_TURN_INL
#endif

#include <hwy/highway.h>

#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

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

/// From a gradient by a tangent to that by the edge.
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
  const Real of_first = factor * edges.inverse_before * edges.inverse_before;
  const Real of_last = factor * edges.inverse_after * edges.inverse_after;
  const Real of_cross = factor * edges.inverse_before * edges.inverse_after;
  EdgeBlocks blocks;
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) {
      const Real aa = r == c ? one - a.of[r] * a.of[c] : negative(a.of[r] * a.of[c]);
      const Real bb = b.of[r] * b.of[c];
      blocks.first.of[r][c] = of_first * aa;
      blocks.last.of[r][c] = of_last * (r == c ? one - bb : negative(bb));
      blocks.cross.of[r][c] = of_cross * (aa - bb + b.of[r] * (cosine * a.of[c]));
    }
  }
  return blocks;
}

/// Adds Jᵀ u uᵀ J, times a factor.
HWY_INLINE void add_along(const TwoEdges& edges, Real factor, const Vector& u, EdgeBlocks& blocks) {
  const Vector before = by_edge(edges.before, edges.inverse_before, u);
  const Vector after = by_edge(edges.after, edges.inverse_after, u);
  for (std::size_t r = 0; r < 3; ++r) {
    const Real of_before = factor * before.of[r];
    const Real of_after = factor * after.of[r];
    for (std::size_t c = 0; c < 3; ++c) {
      blocks.first.of[r][c] = blocks.first.of[r][c] + of_before * before.of[c];
      blocks.last.of[r][c] = blocks.last.of[r][c] + of_after * after.of[c];
      blocks.cross.of[r][c] = blocks.cross.of[r][c] + of_after * before.of[c];
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
      below_first.of[r][c] = negative(first.of[r][c] + cross.of[r][c]);
      above_last.of[r][c] = negative(last.of[r][c] + cross.of[r][c]);
      middle.of[r][c] = first.of[r][c] + last.of[r][c] + cross.of[r][c] + cross.of[c][r];
    }
  }
  add_diagonal<U>(first, node - 1, lane, system);
  add_below<U>(below_first, node - 1, 1, lane, system);
  add_below<U>(cross, node - 1, 2, lane, system);
  add_diagonal<U>(middle, node, lane, system);
  add_below<U>(above_last, node, 1, lane, system);
  add_diagonal<U>(last, node + 1, lane, system);
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
