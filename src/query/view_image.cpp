#include "src/query/view_image.hpp"

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace fiber {
namespace {

using Eigen::Vector3d;

constexpr double rounding = 0x1p-42;

/// value · 2^−exponent, so that the largest coordinate is about 1.
Vector3d scaled(const Vector3d& vector, int exponent) {
  return vector.unaryExpr([exponent](double value) { return std::ldexp(value, -exponent); });
}

int exponent_of(double value) {
  int exponent = 0;
  std::frexp(value, &exponent);
  return exponent;
}

class ParallelImage {
 public:
  ParallelImage(const std::vector<Vector3d>& points, const Vector3d& direction) {
    Vector3d lower = points.front();
    Vector3d upper = lower;
    for (const Vector3d& point : points) {
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
    middle_ = 0.5 * lower + 0.5 * upper;
    exponent_ = exponent_of((upper - lower).maxCoeff());
    const Vector3d along =
        scaled(direction, exponent_of(direction.cwiseAbs().maxCoeff())).normalized();
    right_ = along.unitOrthogonal();
    up_ = right_.cross(along);
  }

  Vector3d operator()(const Vector3d& point) const {
    const Vector3d offset = scaled(point - middle_, exponent_);
    return {right_.dot(offset), up_.dot(offset), 0.0};
  }

 private:
  Vector3d middle_;
  Vector3d right_;
  Vector3d up_;
  int exponent_;
};

void make_parallel_image(const FiberAssembly& fibers, const Vector3d& direction,
                         FiberAssembly& image) {
  std::vector<Vector3d> points;
  std::vector<double> radii(fibers.point_count(), rounding);
  if (fibers.point_count() > 0) {
    const ParallelImage projected(fibers.points(), direction);
    points.reserve(fibers.point_count());
    for (const Vector3d& point : fibers.points()) {
      points.push_back(projected(point));
    }
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    radii[fibers.offsets()[fiber + 1] - 1] = 0.0;
  }
  image.assign_segments(points, fibers.offsets(), radii);
}

/// Where the sphere around the eye is pierced; the origin for the eye itself.
Vector3d seen_from(const Vector3d& eye, const Vector3d& point) {
  const Vector3d offset = point - eye;
  const double largest = offset.cwiseAbs().maxCoeff();
  return largest > 0.0 ? scaled(offset, exponent_of(largest)).normalized() : Vector3d::Zero();
}

double radius_of_arc(const Vector3d& from, const Vector3d& to) {
  const bool ends_in_eye = from == Vector3d::Zero() || to == Vector3d::Zero();
  return rounding + (ends_in_eye ? 1.0 : 0.25 * (to - from).squaredNorm());
}

void make_sphere_image(const FiberAssembly& fibers, const Vector3d& eye, FiberAssembly& image) {
  std::vector<Vector3d> points;
  std::vector<double> radii(fibers.point_count(), 0.0);
  points.reserve(fibers.point_count());
  for (const Vector3d& point : fibers.points()) {
    points.push_back(seen_from(eye, point));
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      radii[i] = radius_of_arc(points[i], points[i + 1]);
    }
  }
  image.assign_segments(points, fibers.offsets(), radii);
}

}  // namespace

void make_view_image(const FiberAssembly& fibers, const View& view, FiberAssembly& image) {
  if (view.is_perspective) {
    make_sphere_image(fibers, view.eye, image);
  } else {
    make_parallel_image(fibers, view.direction, image);
  }
}

}  // namespace fiber
