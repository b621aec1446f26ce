#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include "src/geometry/exact_numbers.hpp"

namespace fiber {

/// A point in homogeneous coordinates: the fourth is 1, or 0 for one at infinity. One that has an
/// id is moved by a perturbation of its own.
struct PerturbedPoint {
  std::array<Integer, 4> coordinates;
  std::optional<std::uint32_t> id;
};

/// The term that decides the sign of a polynomial in infinitesimal perturbations.
struct LeadingTerm {
  Integer coefficient = 0;  ///< not 0
  /// The perturbations it has as factors, the smallest first, then 0s: 1 + 3 id + axis.
  std::array<std::uint64_t, 4> perturbations{};

  int sign() const { return coefficient.sign(); }

  /// The other is infinitely small beside it.
  bool dominates(const LeadingTerm& other) const { return perturbations < other.perturbations; }
};

/// On which side of the plane through the first three points the fourth is: positive where it sees
/// them run counter-clockwise; twice the area times the distance, six times the volume [units³].
///
/// Never 0: where the points themselves are in one plane, their perturbation decides (simulation of
/// simplicity, Edelsbrunner and Mücke 1990). The coordinates of a point with an id are moved by
/// ε(1 + 3 id + axis), where ε(k + 1) is smaller than any power of ε(k); so all questions about
/// points are answered as for one and the same set of points in general position. A determinant is
/// linear in each row, so its coefficients are determinants with rows replaced by unit vectors, and
/// the first that is not 0 in the order of their terms leads.
///
/// @param points ids differ; a point without one is the same in all questions. Three have ids and
///               the fourth is not all 0, or all have
LeadingTerm perturbed_orientation(const std::array<PerturbedPoint, 4>& points);

}  // namespace fiber
