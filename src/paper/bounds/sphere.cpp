#include "src/paper/bounds/sphere.hpp"

#include <Eigen/QR>
#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <utility>

namespace fiber {
namespace {

using Eigen::Vector3d;
using Eigen::Vector3f;

/// Points whose edges' smallest pivot is this small beside the largest define no sphere.
constexpr double dependent = 1.5e-8;

/// The state of Welzl's recursion: points that must lie on the surface, and the sphere they define.
class Support {
 public:
  explicit Support(const std::vector<Vector3d>& points) : points_(points) {}

  const MinimalSphere& sphere() const { return sphere_; }
  std::uint32_t size() const { return sphere_.basis_size; }

  /// The support with one more point: the smallest sphere through all of them.
  /// @return false if the points are affinely dependent; the sphere is unchanged then
  bool with(std::uint32_t index, Support& larger) const {
    larger.sphere_.basis = sphere_.basis;
    larger.sphere_.basis[size()] = index;
    larger.sphere_.basis_size = size() + 1;
    return larger.circumscribe();
  }

 private:
  /// Center = p0 + c with c in the span of the edges qi = pi − p0 and 2 qi·c = |qi|². By the QR
  /// decomposition of the edges: Gram's matrix would square their condition number, and make a
  /// sphere through four points that are nearly in a plane too large by 1e-9 and more.
  bool circumscribe() {
    const Vector3d& p0 = points_[sphere_.basis[0]];
    const auto n = static_cast<Eigen::Index>(size()) - 1;
    using UpTo3 = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, 0, 3, 3>;
    using VectorUpTo3 = Eigen::Matrix<double, Eigen::Dynamic, 1, 0, 3, 1>;
    UpTo3 edges(3, n);
    for (Eigen::Index i = 0; i < n; ++i) {
      edges.col(i) = points_[sphere_.basis[static_cast<std::size_t>(i) + 1]] - p0;
    }
    Vector3d offset = Vector3d::Zero();
    if (n > 0) {
      const double scale = edges.cwiseAbs().maxCoeff();
      if (!(scale > 0.0)) {
        return false;
      }
      edges /= scale;  // so that squares neither over- nor underflow
      Eigen::ColPivHouseholderQR<UpTo3> qr(edges);
      qr.setThreshold(dependent);
      if (qr.rank() < n) {
        return false;
      }
      const VectorUpTo3 half_squares =
          0.5 * (qr.colsPermutation().transpose() * edges.colwise().squaredNorm().transpose());
      VectorUpTo3 c = VectorUpTo3::Zero(3);
      c.head(n) = qr.matrixR().topLeftCorner(n, n).triangularView<Eigen::Upper>().transpose().solve(
          half_squares);
      c.applyOnTheLeft(qr.householderQ());
      offset = scale * c;
    }
    sphere_.center = p0 + offset;
    // By the farthest of the support: rounding must not leave one of them outside.
    sphere_.squared_radius = 0.0;
    for (std::uint32_t i = 0; i < size(); ++i) {
      sphere_.squared_radius = std::max(sphere_.squared_radius,
                                        (points_[sphere_.basis[i]] - sphere_.center).squaredNorm());
    }
    return true;
  }

  const std::vector<Vector3d>& points_;
  MinimalSphere sphere_;
};

/// The smallest sphere around order[0..count) that has the support on its surface. The recursion is
/// over the support: four deep at most.
MinimalSphere enclose(const std::vector<Vector3d>& points, std::vector<std::uint32_t>& order,
                      std::size_t count, const Support& support) {
  if (support.size() == 4) {
    return support.sphere();
  }
  MinimalSphere best = support.sphere();
  for (std::size_t i = 0; i < count; ++i) {
    const std::uint32_t index = order[i];
    if ((points[index] - best.center).squaredNorm() <= best.squared_radius) {
      continue;
    }
    Support larger(points);
    if (!support.with(index, larger)) {
      continue;
    }
    best = enclose(points, order, i, larger);
    std::rotate(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(i),
                order.begin() + static_cast<std::ptrdiff_t>(i) + 1);
  }
  return best;
}

/// Shuffles: the same way for the same count, on every machine.
void shuffle(std::vector<std::uint32_t>& order) {
  std::minstd_rand draw;
  for (std::size_t left = order.size(); left > 1; --left) {
    std::swap(order[left - 1], order[draw() % left]);
  }
}

constexpr float infinity = std::numeric_limits<float>::infinity();

Sphere unbounded_sphere() { return {Vector3f::Zero(), infinity}; }

/// Magnitude of the largest coordinate a sphere reaches [m].
float reach(const Sphere& sphere) { return sphere.center.cwiseAbs().maxCoeff() + sphere.radius; }

/// Pads a radius by what rounding may cost at this magnitude.
float padded(float radius, float magnitude) {
  return radius + magnitude * 0x1p-20F + std::numeric_limits<float>::min();
}

}  // namespace

MinimalSphere minimal_sphere(const std::vector<Vector3d>& points,
                             std::vector<std::uint32_t>& order) {
  shuffle(order);
  MinimalSphere sphere = enclose(points, order, order.size(), Support(points));
  // Rounding and dependent points may leave one outside by a little: the radius takes them in.
  for (const std::uint32_t index : order) {
    sphere.squared_radius =
        std::max(sphere.squared_radius, (points[index] - sphere.center).squaredNorm());
  }
  return sphere;
}

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
