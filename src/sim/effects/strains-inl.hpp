// Strains of rods side by side, which no rigid motion changes, and the derivatives of energies of
// them. Included once per instruction set, so it has the guard that Highway asks for instead of
// #pragma once.
#if defined(FIBER_SIM_EFFECTS_STRAINS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef FIBER_SIM_EFFECTS_STRAINS_INL
#undef FIBER_SIM_EFFECTS_STRAINS_INL
#else
#define FIBER_SIM_EFFECTS_STRAINS_INL
#endif

#include <cmath>
#include <limits>

#include "src/sim/edges.hpp"
#include "src/sim/simd-inl.hpp"

HWY_BEFORE_NAMESPACE();
namespace fiber {
namespace HWY_NAMESPACE {

/// How much longer an edge is than it was.
HWY_INLINE Real lengthening(const RodPack& rods, const SimdBatch& earlier, std::size_t edge,
                            std::size_t lane) {
  return load(rods.lengths[edge], lane) - load(earlier, lane);
}

/// Adds the derivatives of half the square of that, times a stiffness against stretch by the length
/// at rest.
template <std::size_t U>
HWY_INLINE void add_lengthening(const RodPack& rods, const SimdBatch& earlier, Real stiffness,
                                std::size_t edge, std::size_t lane, PackSystem& system) {
  const Vector tangent = tangent_at(rods, edge, lane);
  const Real by_length = stiffness * load(rods.inverse_stretching_lengths[edge], lane);
  const Real tension = by_length * lengthening(rods, earlier, edge, lane);
  // As in Stretch, the part that is negative definite under pressure is left out.
  const Real sideways = hn::Max(real(0.0), tension * load(rods.inverse_lengths[edge], lane));
  add_edge<U>(tension * tangent, block_of(sideways, (by_length - sideways) * tangent, tangent),
              edge, lane, system);
}

/// The turn at a node, and how much larger it is than wanted.
struct SizedTurn {
  Vector turn;
  Real size;
  Real wanted;
  Real excess;
};

HWY_INLINE SizedTurn sized_turn(const TwoEdges& edges, Real wanted) {
  const Vector turn = edges.after - edges.before;
  const Real size = hn::Sqrt(dot(turn, turn));
  return {turn, size, wanted, size - wanted};
}

/// Adds the derivatives of half the square of the excess, times a stiffness.
/// @param direction    of the turn
/// @param min_sideways share of the stiffness that the matrix has across this direction, at least.
///                     A rod that is straighter than it wants to be gives way sideways: below 0
///                     that is met as far as another effect's matrix makes up for it.
template <std::size_t U>
HWY_INLINE void add_sized_turn(const TwoEdges& edges, const SizedTurn& turn,
                               const Vector& direction, Real stiffness, Real min_sideways,
                               std::size_t node, std::size_t lane, PackSystem& system) {
  const Real one = real(1.0);
  const Vector gradient = stiffness * turn.excess * direction;
  add_gradient<U>(edges, negative(gradient), gradient, node, lane, system);
  const Real smallest = real(std::numeric_limits<double>::min());
  const Real share = hn::Max(min_sideways, turn.excess / hn::Max(turn.size, smallest));
  const auto is_straight = hn::Eq(turn.wanted, real(0.0));
  const Real sideways = hn::IfThenElse(is_straight, one, share);
  EdgeBlocks blocks = isotropic_blocks(edges, stiffness * sideways);
  add_along(edges, stiffness * (one - sideways), direction, blocks);
  add_hessian<U>(blocks, node, lane, system);
}

// With twist, cross-sections have directions of their own.

constexpr std::size_t section_unknowns = 4;

/// The derivative of a strain at a node by all unknowns from the previous node to the next one.
struct SectionDerivative {
  static constexpr std::size_t size = 2 * section_unknowns + 3;
  Real values[size];
};

/// @param by_before derivative by the first point of the edge before the node
/// @param by_after  by the second point of the edge after it
/// @param by_angles by the angles of the two edges
HWY_INLINE SectionDerivative section_derivative(const Vector& by_before, const Vector& by_after,
                                                const Real (&by_angles)[2]) {
  SectionDerivative derivative;
  for (std::size_t k = 0; k < 3; ++k) {
    derivative.values[k] = by_before.xyz[k];
    derivative.values[section_unknowns + k] = hn::Neg(by_before.xyz[k] + by_after.xyz[k]);
    derivative.values[2 * section_unknowns + k] = by_after.xyz[k];
  }
  derivative.values[3] = by_angles[0];
  derivative.values[section_unknowns + 3] = by_angles[1];
  return derivative;
}

/// The derivative of a strain whose change is the product of this vector with the rotation of the
/// section after the node against that before it.
HWY_INLINE SectionDerivative by_rotation(const RodPack& rods, const Vector& rotation,
                                         std::size_t node, std::size_t lane) {
  const Vector before = tangent_at(rods, node - 1, lane);
  const Vector after = tangent_at(rods, node, lane);
  const Real about_before = dot(rotation, before);
  const Real about_after = dot(rotation, after);
  const Vector by_before = load(rods.inverse_lengths[node - 1], lane) * cross(rotation, before) +
                           about_before * director_turn(rods, node - 1, lane);
  const Vector by_after = load(rods.inverse_lengths[node], lane) * cross(rotation, after) +
                          about_after * director_turn(rods, node, lane);
  return section_derivative(by_before, by_after, {hn::Neg(about_before), about_after});
}

HWY_INLINE SectionDerivative twist_derivative(const RodPack& rods, std::size_t node,
                                              std::size_t lane) {
  const Vector binormal =
      curvature_binormal(tangent_at(rods, node - 1, lane), tangent_at(rods, node, lane));
  const Real half = real(0.5);
  const Vector by_before = director_turn(rods, node - 1, lane) -
                           half * load(rods.inverse_lengths[node - 1], lane) * binormal;
  const Vector by_after =
      director_turn(rods, node, lane) + half * load(rods.inverse_lengths[node], lane) * binormal;
  return section_derivative(by_before, by_after, {real(-1.0), real(1.0)});
}

/// Adds the derivatives of an energy that is half the square of a strain times a stiffness, without
/// the second derivatives of the strain (Gauss-Newton).
/// @param moment its derivative by the strain
HWY_INLINE void add_square(const SectionDerivative& derivative, Real moment, Real stiffness,
                           std::size_t node, std::size_t lane, PackSystem& system) {
  const std::size_t start = section_unknowns * (node - 1);
  SimdBatch* const gradient = &system.gradient[start];
  SimdBatch* const hessian = &system.hessian[start * column_height<section_unknowns>];
  for (std::size_t c = 0; c < SectionDerivative::size; ++c) {
    add(moment * derivative.values[c], gradient[c], lane);
    const Real scaled = stiffness * derivative.values[c];
    for (std::size_t r = c; r < SectionDerivative::size; ++r) {
      add(scaled * derivative.values[r], hessian[c * column_height<section_unknowns> + r - c],
          lane);
    }
  }
}

/// The tangent and the two material directions of a cross-section.
struct Section {
  Vector tangent;
  Vector directions[2];
};

/// @param angle of the first material direction against the director
HWY_INLINE Section section_of(const Vector& tangent, const Vector& director, Real angle) {
  SimdBatch cosines;
  SimdBatch sines;
  store(angle, sines, 0);
  for (std::size_t l = 0; l < lanes_at_once(); ++l) {
    const CosineSine turned = cosine_and_sine(sines[l]);
    cosines[l] = turned.cosine;
    sines[l] = turned.sine;
  }
  const Vector across = cross(tangent, director);
  const Real cosine = load(cosines, 0);
  const Real sine = load(sines, 0);
  return {tangent, {cosine * director + sine * across, cosine * across - sine * director}};
}

/// How the rod bends between two cross-sections, along their material directions.
struct SectionBend {
  Real values[2];

  /// The product with the rotation of the section after the node against that before it is the
  /// change of the value.
  Vector by_rotation[2];
};

/// The components of the turn along the mean of both sections' material directions: as
/// Bergou et al. (2008, Eq. 2), but as long as the turn, 2 sin(φ/2) for the angle φ, and not
/// 2 tan(φ/2), which a fold has none of. A fold has no side: towards it the strain vanishes, over
/// so wide an angle that to pass through one resists no more than a few times as much as any turn.
HWY_INLINE SectionBend section_bend(const Section& before, const Section& after) {
  const Vector sum = before.tangent + after.tangent;
  const Vector binormal = cross(before.tangent, after.tangent);
  const Real by_length = real(1.0) / (dot(sum, sum) + real(fold_width * fold_width));
  // Small turns are exact.
  const Real inverse = real(std::sqrt(1.0 + 0.25 * fold_width * fold_width)) * hn::Sqrt(by_length);
  SectionBend bend;
  for (std::size_t j = 0; j < 2; ++j) {
    const Vector& of_before = before.directions[j];
    const Vector& of_after = after.directions[j];
    const Real value = inverse * (dot(after.tangent, of_before) - dot(before.tangent, of_after));
    bend.values[j] = value;
    bend.by_rotation[j] =
        inverse * (cross(after.tangent, of_before) + cross(before.tangent, of_after)) +
        value * by_length * binormal;
  }
  return bend;
}

}  // namespace HWY_NAMESPACE
}  // namespace fiber
HWY_AFTER_NAMESPACE();

#endif  // per-target include guard
