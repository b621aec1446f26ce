#include "src/geometry/gauss_integral.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <optional>

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double pi = 3.14159265358979323846;

/// A parallelogram with the corners a, b, c, d in turn, b − a = c − d = u and a − d = b − c = v.
struct Parallelogram {
  Vector3d a, b, c, d, u, v;
};

/// The differences p − q, in a power of two near their extent: angles know no units, and nothing
/// leaves the range of double.
Parallelogram differences(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                          const Vector3d& q1) {
  Eigen::Matrix<double, 3, 6> vectors;
  vectors << p0 - q0, p1 - q0, p1 - q1, p0 - q1, p1 - p0, q1 - q0;
  int exponent = 0;
  std::frexp(vectors.cwiseAbs().maxCoeff(), &exponent);
  vectors = vectors.unaryExpr([exponent](double value) { return std::ldexp(value, -exponent); });
  return {vectors.col(0), vectors.col(1), vectors.col(2),
          vectors.col(3), vectors.col(4), vectors.col(5)};
}

/// a·(u×v), or 0 where it is no more than rounding: neighbours on a fibre have a corner in the
/// origin, and its angles would make much of it.
double volume(const Parallelogram& shape) {
  const Vector3d u = shape.u.cwiseAbs();
  const Vector3d v = shape.v.cwiseAbs();
  const Vector3d sums(u.y() * v.z() + u.z() * v.y(), u.z() * v.x() + u.x() * v.z(),
                      u.x() * v.y() + u.y() * v.x());
  const double value = shape.a.dot(shape.u.cross(shape.v));
  return std::abs(value) > 0x1p-50 * shape.a.cwiseAbs().dot(sums) ? value : 0.0;
}

/// Half the solid angle of a triangle, whose corners' triple product is the volume (van Oosterom
/// and Strackee 1983, eq. 8); nothing where the triangle is seen so nearly as a half plane that it
/// would be inaccurate.
std::optional<double> half_solid_angle(double volume, const Vector3d& a, const Vector3d& b,
                                       const Vector3d& c) {
  constexpr double min_part = 0x1p-6;
  const double length_a = a.norm();
  const double length_b = b.norm();
  const double length_c = c.norm();
  const double product = length_a * length_b * length_c;
  const double cosine = product + a.dot(b) * length_c + b.dot(c) * length_a + c.dot(a) * length_b;
  if (std::abs(volume) + std::abs(cosine) < min_part * product) {
    return std::nullopt;
  }
  return std::atan2(volume, cosine);
}

/// By the angles between neighbouring faces of the pyramid, less a right angle each (Klenin and
/// Langowski 2000, eq. 16a); their sine is that of the normals' cross product, which is the volume
/// times the edge between them.
double solid_angle_by_faces(double volume, const Parallelogram& shape) {
  const auto& [a, b, c, d, u, v] = shape;
  const double magnitude = std::abs(volume);
  const Vector3d ab = a.cross(u);
  const Vector3d bc = v.cross(b);
  const Vector3d cd = u.cross(c);
  const Vector3d da = d.cross(v);
  const double sum =
      std::atan2(ab.dot(bc), b.norm() * magnitude) + std::atan2(bc.dot(cd), c.norm() * magnitude) +
      std::atan2(cd.dot(da), d.norm() * magnitude) + std::atan2(da.dot(ab), a.norm() * magnitude);
  return std::copysign(sum, volume);
}

}  // namespace

double gauss_integral(const Vector3d& p0, const Vector3d& p1, const Vector3d& q0,
                      const Vector3d& q1) {
  const Parallelogram shape = differences(p0, p1, q0, q1);
  const double product = volume(shape);
  if (product == 0.0) {
    return 0.0;
  }
  const std::optional<double> first = half_solid_angle(product, shape.a, shape.b, shape.c);
  const std::optional<double> second = half_solid_angle(product, shape.a, shape.c, shape.d);
  return first && second ? (*first + *second) / (2.0 * pi)
                         : solid_angle_by_faces(product, shape) / (4.0 * pi);
}

}  // namespace fiber
