#pragma once

#include <vector>

#include "validation/geometry/hard_motions.hpp"
#include "validation/geometry/time_polynomial.hpp"

namespace fiber {

/// Proves of pieces of a motion that the capsules do not touch in them.
///
/// The distance of two segments is the least of those of each end from the other segment, and of
/// the lines, where the nearest points of these are inside both. For each of these five kinds there
/// are polynomials of time that are positive where the distance is more than the radii, or where it
/// does not count. As these are followed to any power of time, a piece need be no shorter than the
/// root of the gap.
class MotionSeparation {
 public:
  explicit MotionSeparation(const HardMotion& motion);

  /// Whether there surely is no contact between two times.
  bool holds_between(long double begin, long double end) const;

 private:
  /// All of them positive: then points of a kind are further apart than the radii, or others are
  /// the nearest ones.
  using Case = std::vector<TimePolynomial>;

  void add_end(const TimePolynomialVector& offset, const TimePolynomialVector& along,
               const TimePolynomial& squared_limit);
  void add_lines(const TimePolynomialVector& u, const TimePolynomialVector& v,
                 const TimePolynomialVector& w, const TimePolynomial& squared_limit);

  std::vector<std::vector<Case>> kinds_;  // of which one case each must hold
};

}  // namespace fiber
