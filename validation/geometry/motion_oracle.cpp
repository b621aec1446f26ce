#include "validation/geometry/motion_oracle.hpp"

#include <algorithm>
#include <boost/multiprecision/cpp_int.hpp>
#include <cmath>
#include <vector>

#include "validation/geometry/motion_score.hpp"

namespace fiber {
namespace {

using reference::MovingPair;
using reference::Nearest;
using reference::Placed;
using reference::Vector;
using Rational = boost::multiprecision::cpp_rational;
using Verdict = MotionOracle::Verdict;

constexpr int max_looks = 20000;
constexpr int crossing_pieces = 256;

/// Where parallel lines have made the textbook's solution worthless: the best of two projections.
long double distance_of(const Placed<long double>& placed) {
  Nearest<long double> best = nearest_of(placed);
  const auto& [u, v, w] = placed;
  const Vector<long double> normal = cross(u, v);
  const long double squared = dot(normal, normal);
  const long double s = dot(cross(v, w), normal);
  if (s > 0 && s < squared) {
    const long double x = s / squared;
    const long double y = reference::clamped<long double>(dot(w + x * u, v), dot(v, v));
    best.squared = std::min(best.squared, reference::squared_at<long double>(placed, x, y));
  }
  return std::sqrt(best.squared);
}

long double rounding_of(const HardMotion& motion) {
  return 1e-17L * (static_cast<long double>(extent_of(motion)) + motion.radius_a + motion.radius_b);
}

/// Undecided if the volume that the segments span has the same sign at both times.
Verdict crosses_once(const MovingPair<Rational>& exact, Rational begin, Rational end) {
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

}  // namespace

MotionOracle::MotionOracle(const HardMotion& motion)
    : motion_(motion), rough_(motion), error_(rounding_of(motion)) {}

long double MotionOracle::fastest() const {
  const auto& [u, v, w] = rough_.rate();
  long double most = 0.0L;
  for (const Vector<long double>& rate : {w, w + u, w - v, w + u - v}) {
    most = std::max(most, std::sqrt(dot(rate, rate)));
  }
  return most;
}

long double MotionOracle::closing(double time) const {
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

bool MotionOracle::is_within(double time, double gap) const {
  const long double reach = rough_.limit + gap;
  const long double distance = distance_of(rough_.at(time));
  if (std::abs(distance - reach) > error_ + 1e-17L * reach) {
    return distance < reach;
  }
  const MovingPair<Rational> exact(motion_);
  const Rational limit = exact.limit + Rational(gap);
  return nearest_of(exact.at(Rational(time))).squared <= limit * limit;
}

Verdict MotionOracle::contact_before(double end) const {
  // Where the others take so many looks, polynomials take hardly more for any gap.
  constexpr int looks_without_polynomials = 200;
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
        stands_between(piece) || (looks > looks_without_polynomials && is_separated(piece))) {
      continue;
    }
    if (looks > max_looks || !(piece.begin < middle && middle < piece.end)) {
      return Verdict::UNDECIDED;
    }
    pieces.push_back({middle, piece.end});
    pieces.push_back({piece.begin, middle});
  }
  return Verdict::NONE;
}

Verdict MotionOracle::crosses_between(double lower, double upper) const {
  const MovingPair<Rational> exact(motion_);
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

/// Whether the plane between the segments in the middle of a piece is between them all the time:
/// their ends move on straight lines.
bool MotionOracle::stands_between(const Piece& piece) const {
  const Placed<long double> placed = rough_.at(0.5L * (piece.begin + piece.end));
  const Nearest<long double> nearest = nearest_of(placed);
  const Vector<long double> between = placed.w + nearest.s * placed.u - nearest.t * placed.v;
  const Vector<long double> normal = (1.0L / std::sqrt(nearest.squared)) * between;
  for (const long double when : {piece.begin, piece.end}) {
    const auto [u, v, w] = rough_.at(when);
    for (const Vector<long double>& corner : {w, w + u, w - v, w + u - v}) {
      if (!(dot(normal, corner) > rough_.limit + error_)) {
        return false;
      }
    }
  }
  return true;
}

bool MotionOracle::is_separated(const Piece& piece) const {
  if (!separation_) {
    separation_.emplace(motion_);
  }
  return separation_->holds_between(piece.begin, piece.end);
}

}  // namespace fiber
