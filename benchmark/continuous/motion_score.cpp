#include "continuous/motion_score.hpp"

#include <algorithm>
#include <array>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <limits>
#include <vector>

namespace fiber::bench {
namespace {

using Rational = boost::multiprecision::cpp_rational;

template <class Number>
using Vector = std::array<Number, 3>;

template <class Number>
Vector<Number> operator+(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] + b[0], a[1] + b[1], a[2] + b[2]};
}
template <class Number>
Vector<Number> operator-(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[0] - b[0], a[1] - b[1], a[2] - b[2]};
}
template <class Number>
Vector<Number> operator*(const Number& factor, const Vector<Number>& a) {
  return {factor * a[0], factor * a[1], factor * a[2]};
}
template <class Number>
Number dot(const Vector<Number>& a, const Vector<Number>& b) {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
template <class Number>
Vector<Number> cross(const Vector<Number>& a, const Vector<Number>& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}

/// Two segments at one time: directions, and from the start of the second to that of the first.
template <class Number>
struct Placed {
  Vector<Number> u;
  Vector<Number> v;
  Vector<Number> w;
};

template <class Number>
class Motion {
 public:
  explicit Motion(const HardMotion& motion)
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

  const Number limit;  // [m]

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
    // Of a parameter that is off, the best one beside it.
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

/// Where parallel lines have made the textbook's solution worthless: the best of two projections.
long double distance_of(const Placed<long double>& placed) {
  Nearest<long double> best = nearest_of(placed);
  const auto& [u, v, w] = placed;
  const Vector<long double> normal = cross(u, v);
  const long double squared = dot(normal, normal);
  const long double s = dot(cross(v, w), normal);
  if (s > 0 && s < squared) {
    const long double x = s / squared;
    const long double y = clamped<long double>(dot(w + x * u, v), dot(v, v));
    best.squared = std::min(best.squared, squared_at<long double>(placed, x, y));
  }
  return std::sqrt(best.squared);
}

/// What the claims about a motion are held against.
class Truth {
 public:
  enum class Verdict { NONE, CONTACT, UNDECIDED };

  explicit Truth(const HardMotion& motion)
      : motion_(motion), rough_(motion), error_(least_error(motion)) {}

  long double fastest() const {
    const auto& [u, v, w] = rough_.rate();
    long double most = 0.0L;
    for (const Vector<long double>& rate : {w, w + u, w - v, w + u - v}) {
      most = std::max(most, std::sqrt(dot(rate, rate)));
    }
    return most;
  }

  /// How fast the nearest points come nearer at this time [m per motion]; 0 where they are so near
  /// that rounding would make the direction.
  long double closing(double time) const {
    const Placed<long double> placed = rough_.at(time);
    const Nearest<long double> nearest = nearest_of(placed);
    if (std::sqrt(nearest.squared) < 1e3L * error_) {
      return 0.0L;
    }
    const auto& [u, v, w] = rough_.rate();
    const Vector<long double> between = placed.w + nearest.s * placed.u - nearest.t * placed.v;
    const Vector<long double> rate = w + nearest.s * u - nearest.t * v;
    return -dot(between, rate) / std::sqrt(nearest.squared);
  }

  /// Whether the gap is at most this at a time; exact.
  bool is_within(double time, double gap) const {
    const long double reach = rough_.limit + gap;
    const long double distance = distance_of(rough_.at(time));
    if (std::abs(distance - reach) > error_ + 1e-17L * reach) {
      return distance < reach;
    }
    const Motion<Rational> exact(motion_);
    const Rational limit = exact.limit + Rational(gap);
    return nearest_of(exact.at(Rational(time))).squared <= limit * limit;
  }

  /// Whether there is contact before a time.
  Verdict contact_before(double end) const {
    struct Piece {
      long double begin;
      long double end;
    };
    const long double speed = fastest() * (1.0L + 1e-15L);
    std::vector<Piece> pieces;
    if (end > 0.0) {
      pieces.push_back({0.0L, end});
    }
    for (int looks = 0; !pieces.empty(); ++looks) {
      const Piece piece = pieces.back();
      pieces.pop_back();
      const long double middle = 0.5L * (piece.begin + piece.end);
      const long double gap = distance_of(rough_.at(middle)) - rough_.limit;
      if (gap + error_ < 0.0L && middle < end) {
        return Verdict::CONTACT;
      }
      if (gap - error_ > speed * (0.5L * (piece.end - piece.begin)) * (1.0L + 1e-15L) ||
          keeps_apart(middle, piece.begin, piece.end)) {
        continue;
      }
      if (looks > most_looks || !(piece.begin < middle && middle < piece.end)) {
        return Verdict::UNDECIDED;
      }
      pieces.push_back({middle, piece.end});
      pieces.push_back({piece.begin, middle});
    }
    return Verdict::NONE;
  }

  /// Whether segments without thickness cross between two times, or shortly before the first.
  Verdict crosses_between(double lower, double upper) const {
    const Motion<Rational> exact(motion_);
    // There is no contact before `lower`, but the crossing may be there but for rounding.
    const Rational begin = std::max(0.0, lower - 0x1p-40);
    const Rational step = (Rational(upper) - begin) / crossing_pieces;
    Verdict verdict = Verdict::UNDECIDED;
    for (int i = 0; i < crossing_pieces && verdict != Verdict::CONTACT; ++i) {
      const Verdict piece = crosses_once(exact, begin + i * step, begin + (i + 1) * step);
      verdict = piece == Verdict::UNDECIDED ? verdict : piece;
    }
    return verdict;
  }

  /// Whether the plane between the segments at one time is between them for a while: their ends
  /// move on straight lines.
  bool keeps_apart(long double time, long double begin, long double end) const {
    const Placed<long double> placed = rough_.at(time);
    const Nearest<long double> nearest = nearest_of(placed);
    const Vector<long double> between = placed.w + nearest.s * placed.u - nearest.t * placed.v;
    const Vector<long double> normal = (1.0L / std::sqrt(nearest.squared)) * between;
    for (const long double when : {begin, end}) {
      const auto [u, v, w] = rough_.at(when);
      for (const Vector<long double>& corner : {w, w + u, w - v, w + u - v}) {
        if (!(dot(normal, corner) > rough_.limit + error_)) {
          return false;
        }
      }
    }
    return true;
  }

  double limit() const { return static_cast<double>(rough_.limit); }

 private:
  static constexpr int most_looks = 20000;
  static constexpr int crossing_pieces = 256;

  /// Undecided if the volume that the segments span has the same sign at both times.
  static Verdict crosses_once(const Motion<Rational>& exact, Rational begin, Rational end) {
    const auto is_above = [&](const Rational& time) {
      const Placed<Rational> placed = exact.at(time);
      return dot(placed.w, cross(placed.u, placed.v)) > 0;
    };
    const bool begins_above = is_above(begin);
    if (is_above(end) == begins_above) {
      return Verdict::UNDECIDED;
    }
    constexpr int halvings = 60;
    for (int i = 0; i < halvings; ++i) {
      const Rational middle = (begin + end) / 2;
      (is_above(middle) == begins_above ? begin : end) = middle;
    }
    const auto [u, v, w] = exact.at(begin);
    const Vector<Rational> normal = cross(u, v);
    const Rational squared = dot(normal, normal);
    const Rational s = dot(cross(v, w), normal);
    const Rational t = dot(cross(u, w), normal);
    const Rational slack = squared * Rational(0x1p-40);
    const bool is_inside = s > -slack && s < squared + slack && t > -slack && t < squared + slack;
    return is_inside ? Verdict::CONTACT : Verdict::NONE;
  }

  static long double least_error(const HardMotion& motion) {
    return 1e-17L *
           (static_cast<long double>(extent_of(motion)) + motion.radius_a + motion.radius_b);
  }

  const HardMotion& motion_;
  const Motion<long double> rough_;
  const long double error_;  // [m] of distances in 64 bits
};

}  // namespace

MotionScore& MotionScore::operator+=(const MotionScore& more) {
  motions += more.motions;
  hits += more.hits;
  certain += more.certain;
  without_upper += more.without_upper;
  misses += more.misses;
  false_alarms += more.false_alarms;
  wrongly_certain += more.wrongly_certain;
  wide += more.wide;
  undecided += more.undecided;
  return *this;
}

double extent_of(const HardMotion& motion) {
  double extent = 0.0;
  for (const auto& [a, b] : {std::pair(motion.a_before.data(), motion.b_before.data()),
                             std::pair(motion.a_after.data(), motion.b_after.data())}) {
    for (int i = 0; i < 2; ++i) {
      for (int j = 0; j < 2; ++j) {
        extent = std::max(extent, (a[i] - b[j]).cwiseAbs().maxCoeff());
      }
    }
  }
  return extent;
}

MotionScore judge(const HardMotion& motion, double tolerance, const ContactTime& answer) {
  using Verdict = Truth::Verdict;
  const Truth truth(motion);
  MotionScore score;
  score.motions = 1;
  const Verdict before = truth.contact_before(answer.hit ? answer.lower : 1.0);
  const bool ends_in_contact = !answer.hit && truth.is_within(1.0, 0.0);
  score.misses = before == Verdict::CONTACT || ends_in_contact ? 1 : 0;
  score.undecided = before == Verdict::UNDECIDED ? 1 : 0;
  if (!answer.hit) {
    return score;
  }
  score.hits = 1;
  score.certain = answer.certain ? 1 : 0;
  if (std::isinf(answer.upper)) {
    score.without_upper = 1;
    score.wrongly_certain = answer.certain ? 1 : 0;
    return score;
  }
  score.false_alarms = truth.is_within(answer.upper, tolerance) ? 0 : 1;
  if (answer.certain && !truth.is_within(answer.upper, 0.0)) {
    const Verdict crosses =
        truth.limit() > 0.0 ? Verdict::NONE : truth.crosses_between(answer.lower, answer.upper);
    score.wrongly_certain = crosses == Verdict::CONTACT ? 0 : 1;
  }
  const long double speed = truth.fastest();
  if (10.0L * truth.closing(answer.lower) >= speed) {
    // Times are rounded to doubles.
    score.wide = (answer.upper - answer.lower) * speed > 20.0L * tolerance + 0x1p-44L * speed;
  }
  return score;
}

}  // namespace fiber::bench
