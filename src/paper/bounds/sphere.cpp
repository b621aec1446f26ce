#include "src/paper/bounds/sphere.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "src/paper/bounds/minimal_sphere.hpp"

namespace fiber {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

constexpr float infinity = std::numeric_limits<float>::infinity();

Sphere unbounded_sphere() { return {Vector3f::Zero(), infinity}; }

/// Magnitude of the largest coordinate a sphere reaches [m].
float reach(const Sphere& sphere) { return sphere.center.cwiseAbs().maxCoeff() + sphere.radius; }

/// Pads a radius by what rounding may cost at this magnitude.
float padded(float radius, float magnitude) {
  return radius + magnitude * 0x1p-20F + std::numeric_limits<float>::min();
}

}  // namespace

void fit_around(Sphere& sphere, const Vector3d& center, const CapsuleRun& run) {
  double farthest = 0.0;
  double widest = 0.0;
  for (const Capsule& capsule : run) {
    farthest = std::max(
        {farthest, (capsule.p0 - center).squaredNorm(), (capsule.p1 - center).squaredNorm()});
    widest = std::max(widest, capsule.radius);
  }
  const double radius = std::sqrt(farthest) + widest;
  if (!(center.cwiseAbs().maxCoeff() + radius <= RoundedCapsule::largest_magnitude)) {
    sphere = unbounded_sphere();
    return;
  }
  sphere.center = center.cast<float>();
  sphere.radius = static_cast<float>(radius);
  sphere.radius = padded(sphere.radius, reach(sphere));
}

void fit(Sphere& sphere, const Capsule& capsule, const NoParameters& /*parameters*/) {
  fit_around(sphere, 0.5 * capsule.p0 + 0.5 * capsule.p1, {&capsule, 1});
}

void fit(Sphere& sphere, const CapsuleRun& run, const NoParameters& /*parameters*/) {
  std::vector<Vector3d> points;
  points.reserve(2 * run.size);
  for (const Capsule& capsule : run) {
    points.push_back(capsule.p0);
    points.push_back(capsule.p1);
  }
  std::vector<std::uint32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0U);
  fit_around(sphere, minimal_sphere(points, order).center, run);
}

Sphere merge(const Sphere& a, const Sphere& b) {
  // In double precision, where the squares of whatever float can hold keep their digits.
  const Vector3d center_a = a.center.cast<double>();
  const Vector3d center_b = b.center.cast<double>();
  const auto radius_a = static_cast<double>(a.radius);
  const auto radius_b = static_cast<double>(b.radius);
  const double distance = (center_b - center_a).norm();
  if (radius_a >= distance + radius_b) {
    return a;
  }
  if (radius_b >= distance + radius_a) {
    return b;
  }
  // The sphere's far ends lie on the line through the centres.
  const double along = 0.5 * (distance + radius_b - radius_a);
  Sphere sphere;
  sphere.center = (center_a + (center_b - center_a) * (along / distance)).cast<float>();
  // Whatever rounding made of the centre, the radius reaches around both.
  const Vector3d center = sphere.center.cast<double>();
  sphere.radius = static_cast<float>(
      std::max((center_a - center).norm() + radius_a, (center_b - center).norm() + radius_b));
  sphere.radius = padded(sphere.radius, reach(sphere));
  return sphere;
}

bool overlaps(const Sphere& a, const Sphere& b, float margin) {
  const float reach_of_both = a.radius + b.radius + margin;
  return (b.center - a.center).squaredNorm() <= reach_of_both * reach_of_both + squared_underflow;
}

float distance_lower_bound(const Sphere& a, const Sphere& b) {
  const float squared = (b.center - a.center).squaredNorm() - squared_underflow;
  return std::sqrt(std::max(squared, 0.0F)) - a.radius - b.radius;
}

bool contains(const Sphere& sphere, const Capsule& capsule, const NoParameters& /*parameters*/) {
  const Vector3d center = sphere.center.cast<double>();
  const double farthest = std::max((capsule.p0 - center).norm(), (capsule.p1 - center).norm());
  return farthest + capsule.radius <= static_cast<double>(sphere.radius);
}

double volume(const Sphere& sphere, const NoParameters& /*parameters*/) {
  constexpr double pi = 3.14159265358979323846;
  return 4.0 / 3.0 * pi * std::pow(static_cast<double>(sphere.radius), 3.0);
}

Aabb bounding_box(const Sphere& sphere, const NoParameters& /*parameters*/) {
  Aabb box;
  for (int axis = 0; axis < 3; ++axis) {
    box.lower[axis] = sphere.center[axis] - sphere.radius;
    box.upper[axis] = sphere.center[axis] + sphere.radius;
  }
  return box;
}

std::vector<SplitAxis> split_axes(const Sphere& /*sphere*/, const CapsuleRun& run,
                                  const NoParameters& parameters) {
  Aabb box;
  fit(box, run, parameters);
  return split_axes(box, run, parameters);
}

}  // namespace fiber
