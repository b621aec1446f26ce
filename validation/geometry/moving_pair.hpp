#pragma once

#include <Eigen/Core>
#include <utility>
#include <vector>

#include "validation/geometry/hard_motions.hpp"
#include "validation/geometry/reference_vector.hpp"

/// Two segments that move, as the truth about them is found, in any kind of number: by formulas
/// that the kernel does not use.
namespace fiber::reference {

/// Two segments at one time: directions, and from the start of the second to that of the first.
template <class Number>
struct Placed {
  Vector<Number> u;
  Vector<Number> v;
  Vector<Number> w;
};

template <class Number>
class MovingPair {
 public:
  explicit MovingPair(const HardMotion& motion)
      : limit(Number(motion.radius_a) + Number(motion.radius_b)) {
    const auto difference = [](const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
      return Vector<Number>{Number(a.x()), Number(a.y()), Number(a.z())} -
             Vector<Number>{Number(b.x()), Number(b.y()), Number(b.z())};
    };
    before_ = {difference(motion.a_before[1], motion.a_before[0]),
               difference(motion.b_before[1], motion.b_before[0]),
               difference(motion.a_before[0], motion.b_before[0])};
    const Placed<Number> after{difference(motion.a_after[1], motion.a_after[0]),
                               difference(motion.b_after[1], motion.b_after[0]),
                               difference(motion.a_after[0], motion.b_after[0])};
    rate_ = {after.u - before_.u, after.v - before_.v, after.w - before_.w};
  }

  Placed<Number> at(const Number& time) const {
    return {before_.u + time * rate_.u, before_.v + time * rate_.v, before_.w + time * rate_.w};
  }

  const Placed<Number>& rate() const { return rate_; }

  const Number limit;  ///< [m]

 private:
  Placed<Number> before_;
  Placed<Number> rate_;
};

template <class Number>
Number squared_at(const Placed<Number>& placed, const Number& s, const Number& t) {
  const Vector<Number> between = placed.w + s * placed.u - t * placed.v;
  return dot(between, between);
}

template <class Number>
Number clamped(const Number& numerator, const Number& denominator) {
  if (!(numerator > 0) || !(denominator > 0)) {
    return 0;
  }
  return numerator < denominator ? Number(numerator / denominator) : Number(1);
}

template <class Number>
struct Nearest {
  Number s;
  Number t;
  Number squared;
};

/// The best of the four ends, each with its projection, and where both projections are inside, of
/// the textbook's normal equations.
template <class Number>
Nearest<Number> nearest_of(const Placed<Number>& placed) {
  const auto& [u, v, w] = placed;
  const Number a = dot(u, u);
  const Number b = dot(u, v);
  const Number c = dot(v, v);
  const Number d = dot(u, w);
  const Number e = dot(v, w);
  const Number zero = 0;
  const Number one = 1;
  std::vector<std::pair<Number, Number>> candidates{{zero, clamped<Number>(e, c)},
                                                    {one, clamped<Number>(e + b, c)},
                                                    {clamped<Number>(-d, a), zero},
                                                    {clamped<Number>(b - d, a), one}};
  const Number determinant = a * c - b * b;
  const Number s = b * e - c * d;
  const Number t = a * e - b * d;
  if (s > 0 && s < determinant && t > 0 && t < determinant) {
    const Number inside = s / determinant;
    // The parameter may be off: the other one is the best for it.
    candidates.emplace_back(inside, clamped<Number>(e + inside * b, c));
  }
  Nearest<Number> best{zero, zero, squared_at<Number>(placed, zero, zero)};
  for (const auto& [x, y] : candidates) {
    const Number squared = squared_at<Number>(placed, x, y);
    if (squared < best.squared) {
      best = {x, y, squared};
    }
  }
  return best;
}

}  // namespace fiber::reference
