#include "fiber_proximity/geometry/segment_distance.hpp"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <stdexcept>

#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
/// In the order that LaneDistance adds in.
double dot(const Vector3d& a, const Vector3d& b) {
  return a.x() * b.x() + a.y() * b.y() + a.z() * b.z();
}

/// Two numbers in a register, where the processor has such.
using Two = Eigen::Array2d;

struct TwoVectors {
  Two x;
  Two y;
  Two z;

  TwoVectors(const Two& all_x, const Two& all_y, const Two& all_z) : x(all_x), y(all_y), z(all_z) {}
  TwoVectors(const Vector3d& first, const Vector3d& second)
      : x(first.x(), second.x()), y(first.y(), second.y()), z(first.z(), second.z()) {}

  Two dot(const Vector3d& v) const { return x * v.x() + y * v.y() + z * v.z(); }
  Two squared() const { return x * x + y * y + z * z; }
  TwoVectors operator-() const { return {-x, -y, -z}; }
};

/// a + s·v
TwoVectors add_scaled(const TwoVectors& a, const Two& s, const Vector3d& v) {
  return {a.x + s * v.x(), a.y + s * v.y(), a.z + s * v.z()};
}

/// As LaneDistance::project(), of two offsets.
Two project(const TwoVectors& offset, const Vector3d& direction, double squared_length) {
  const Two along = offset.dot(direction).min(squared_length).max(0.0);
  // A length of 0 leaves no way along it; adding 0 makes 0 of −0.
  return (along + 0.0) / (squared_length > 0.0 ? squared_length : 1.0);
}

double project(const Vector3d& offset, const Vector3d& direction, double squared_length) {
  const double along = dot(offset, direction);
  const double parameter = along < squared_length ? along / squared_length : 1.0;
  return along > 0.0 ? parameter : 0.0;
}

/// The candidates of LaneDistance, in its order and with its bits: those of one segment's ends at
/// once.
class Candidates {
 public:
  Candidates(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0, const Vector3d& q1) {
    const Vector3d u = p1 - p0;
    const Vector3d v = q1 - q0;
    const Vector3d w = p0 - q0;
    const double uu = dot(u, u);
    const double vv = dot(v, v);

    const TwoVectors of_p(w, p1 - q0);
    const Two t = project(of_p, v, vv);
    set(0, Two(0.0, 1.0), t, add_scaled(of_p, -t, v));
    const TwoVectors of_q(w, p0 - q1);
    const Two s = project(-of_q, u, uu);
    set(2, s, Two(0.0, 1.0), add_scaled(of_q, s, u));

    const Vector3d normal = u.cross(v);
    const double denominator = dot(normal, normal);
    const double numerator = dot(v.cross(w), normal);
    const bool is_inside = numerator > 0.0 && numerator < denominator;
    s_[4] = is_inside ? numerator / denominator : 0.0;
    const Vector3d on_p = w + s_[4] * u;
    t_[4] = project(on_p, v, vv);
    delta_[4] = on_p - t_[4] * v;
    squared_[4] = dot(delta_[4], delta_[4]);
  }

  /// The first one of the smallest distance.
  SegmentDistance nearest(double error) const {
    std::size_t best = 0;
    for (std::size_t i = 1; i < count; ++i) {
      best = squared_[i] < squared_[best] ? i : best;
    }
    return {s_[best], t_[best], -delta_[best], std::sqrt(squared_[best]), error};
  }

 private:
  static constexpr std::size_t count = 5;

  void set(std::size_t first, const Two& s, const Two& t, const TwoVectors& delta) {
    const Two squared = delta.squared();
    for (std::size_t i = 0; i < 2; ++i) {
      const auto lane = static_cast<Eigen::Index>(i);
      s_[first + i] = s[lane];
      t_[first + i] = t[lane];
      delta_[first + i] = {delta.x[lane], delta.y[lane], delta.z[lane]};
      squared_[first + i] = squared[lane];
    }
  }

  double s_[count];
  double t_[count];
  Vector3d delta_[count];  // from q's point to p's point [m]
  double squared_[count];
};

/// Times a power of two.
Vector3d scaled(const Vector3d& v, int exponent) {
  return v.unaryExpr([=](double x) { return std::ldexp(x, exponent); });
}

SegmentDistance scaled_segment_distance(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                                        const Vector3d& q1, double extent) {
  const int exponent = std::ilogb(extent);
  SegmentDistance result = Candidates(scaled(p0, -exponent), scaled(p1, -exponent),
                                      scaled(q0, -exponent), scaled(q1, -exponent))
                               .nearest(robust_error * extent);
  result.distance = std::ldexp(result.distance, exponent);
  result.delta = scaled(result.delta, exponent);
  // Distance and error may have been rounded once more, where they are subnormal.
  result.error += std::numeric_limits<double>::denorm_min();
  return result;
}

}  // namespace

SegmentDistance segment_distance(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                                 const Vector3d& q1) {
  const Vector3d upper = p0.cwiseMax(p1).cwiseMax(q0.cwiseMax(q1));
  const Vector3d lower = p0.cwiseMin(p1).cwiseMin(q0.cwiseMin(q1));
  const double extent = (upper - lower).maxCoeff();
  if (extent > 0.0 && !(extent > min_distance_scale && extent < largest_distance_scale)) {
    return scaled_segment_distance(p0, p1, q0, q1, extent);
  }
  return Candidates(p0, p1, q0, q1).nearest(robust_error * extent);
}

const std::vector<std::string>& kernel_names() {
  static const std::vector<std::string> names{"robust", "exact"};
  return names;
}

Kernel kernel_from_name(const std::string& name) {
  const std::vector<std::string>& names = kernel_names();
  const auto found = std::find(names.begin(), names.end(), name);
  if (found == names.end()) {
    throw std::invalid_argument("unknown kernel " + quote(name) + ", known are: " + join(names));
  }
  return static_cast<Kernel>(found - names.begin());
}

SegmentDistance segment_distance(Kernel kernel, const Vector3d& p0, const Vector3d& p1,
                                 const Vector3d& q0, const Vector3d& q1) {
  return kernel == Kernel::EXACT ? exact_segment_distance(p0, p1, q0, q1)
                                 : segment_distance(p0, p1, q0, q1);
}

}  // namespace fiber
