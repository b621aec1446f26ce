#pragma once

#include <optional>

#include "validation/geometry/hard_motions.hpp"
#include "validation/geometry/motion_separation.hpp"
#include "validation/geometry/moving_pair.hpp"

namespace fiber {

/// Whether and when the capsules of a motion touch, by means that share no formula with
/// contact_time(): distances of the textbook's normal equations in 64 bits, on smaller and smaller
/// pieces of the motion until the speed of the ends, a plane that stands still or polynomials of
/// time rule a contact out; exact rationals where these are not enough. Refers to the motion.
class MotionOracle {
 public:
  enum class Verdict { NONE, CONTACT, UNDECIDED };

  explicit MotionOracle(const HardMotion& motion);

  /// [m per motion] No end of one moves faster beside an end of the other.
  long double fastest() const;

  /// How fast the nearest points come nearer at this time [m per motion]; 0 where they are so near
  /// that rounding would make the direction.
  long double closing(double time) const;

  /// Whether the gap is at most this at a time [m]; exact.
  bool is_within(double time, double gap) const;

  /// Whether there is contact before a time.
  Verdict contact_before(double end) const;

  /// Whether segments without thickness cross between two times, or shortly before the first.
  Verdict crosses_between(double lower, double upper) const;

  /// [m] The distance of a contact.
  double limit() const { return static_cast<double>(rough_.limit); }

 private:
  struct Piece {
    long double begin;
    long double end;
  };

  bool stands_between(const Piece& piece) const;
  bool is_separated(const Piece& piece) const;

  const HardMotion& motion_;
  const reference::MovingPair<long double> rough_;
  const long double error_;                             // [m] of distances in 64 bits
  mutable std::optional<MotionSeparation> separation_;  // where it has been needed
};

}  // namespace fiber
