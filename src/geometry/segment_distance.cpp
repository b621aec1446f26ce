#include "fiber_proximity/geometry/segment_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace fiber {
namespace {

using Eigen::Vector3d;

/// Differences of the four end points; all that the distance depends on.
struct Differences {
  Vector3d u;    // p1 − p0
  Vector3d v;    // q1 − q0
  Vector3d w;    // p0 − q0
  Vector3d w_u;  // p1 − q0
  Vector3d w_v;  // p0 − q1

  double largest() const {
    return std::max({u.cwiseAbs().maxCoeff(), v.cwiseAbs().maxCoeff(), w.cwiseAbs().maxCoeff(),
                     w_u.cwiseAbs().maxCoeff(), w_v.cwiseAbs().maxCoeff()});
  }

  void scale(int exponent) {
    for (Vector3d* difference : {&u, &v, &w, &w_u, &w_v}) {
      *difference = difference->unaryExpr([exponent](double x) { return std::ldexp(x, exponent); });
    }
  }
};

/// Best candidate so far: parameters and squared length of delta.
struct Best {
  double s = 0.0;
  double t = 0.0;
  Vector3d delta;  // from q's point to p's point
  double squared = 0.0;

  void consider(double other_s, double other_t, const Vector3d& other_delta) {
    const double other_squared = other_delta.squaredNorm();
    if (other_squared < squared) {
      s = other_s;
      t = other_t;
      delta = other_delta;
      squared = other_squared;
    }
  }
};

/// Parameter in [0, 1] of the projection of a point at `offset` from a segment's start; 0 on a
/// segment of no length.
double project(const Vector3d& offset, const Vector3d& direction, double squared_length) {
  const double dot = offset.dot(direction);
  if (!(dot > 0.0)) {
    return 0.0;
  }
  return dot < squared_length ? dot / squared_length : 1.0;
}

Best closest(const Differences& d) {
  const double uu = d.u.squaredNorm();
  const double vv = d.v.squaredNorm();

  Best best;
  best.t = project(d.w, d.v, vv);  // p0 on q
  best.delta = d.w - best.t * d.v;
  best.squared = best.delta.squaredNorm();

  const double t_p1 = project(d.w_u, d.v, vv);
  best.consider(1.0, t_p1, d.w_u - t_p1 * d.v);
  const double s_q0 = project(-d.w, d.u, uu);
  best.consider(s_q0, 0.0, d.w + s_q0 * d.u);
  const double s_q1 = project(-d.w_v, d.u, uu);
  best.consider(s_q1, 1.0, d.w_v + s_q1 * d.u);

  const Vector3d normal = d.u.cross(d.v);
  const double denominator = normal.squaredNorm();
  const double numerator = d.v.cross(d.w).dot(normal);
  if (numerator > 0.0 && numerator < denominator) {
    const double s = numerator / denominator;
    const Vector3d on_p = d.w + s * d.u;
    const double t = project(on_p, d.v, vv);
    best.consider(s, t, on_p - t * d.v);
  }
  return best;
}

}  // namespace

SegmentDistance segment_distance(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                                 const Vector3d& q1) {
  Differences differences{p1 - p0, q1 - q0, p0 - q0, p1 - q0, p0 - q1};
  const double largest = differences.largest();

  // |u×v|² is of the fourth power of the differences: between these powers of two neither it nor
  // its factors leave the range of double, beyond them everything is scaled to about 1.
  int exponent = 0;
  if (!(largest > 0x1p-100 && largest < 0x1p200) && largest > 0.0) {
    exponent = std::ilogb(largest);
    differences.scale(-exponent);
  }
  const Best best = closest(differences);

  SegmentDistance result{best.s, best.t, -best.delta, std::sqrt(best.squared)};
  if (exponent != 0) {
    result.distance = std::ldexp(result.distance, exponent);
    result.delta = result.delta.unaryExpr([exponent](double x) { return std::ldexp(x, exponent); });
  }
  return result;
}

}  // namespace fiber
