#include "src/paper/bounds/obb.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

namespace fiber {
namespace {

using Eigen::Matrix3d;
using Eigen::Matrix3f;
using Eigen::Vector3d;
using Eigen::Vector3f;

Obb unbounded_box() {
  Obb box;
  box.half_extents.setConstant(std::numeric_limits<float>::infinity());
  return box;
}

bool is_unbounded(const Obb& box) { return !box.half_extents.allFinite(); }

/// A right-handed orthonormal frame with `first` along the given direction and `second` as near to
/// the other as that allows; directions that vanish or coincide are replaced.
Matrix3d frame(const Vector3d& first, const Vector3d& second) {
  Matrix3d axes;
  axes.col(0) = first.isZero(0.0) ? Vector3d::UnitX() : Vector3d(first.stableNormalized());
  const Vector3d unit = second.stableNormalized();
  const Vector3d across = unit - axes.col(0).dot(unit) * axes.col(0);
  // Nearly parallel directions leave nothing but rounding: any other perpendicular is as good.
  axes.col(1) = across.norm() > 1e-8 ? Vector3d(across.normalized()) : axes.col(0).unitOrthogonal();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  return axes;
}

/// Principal axes of a covariance. Eigen's direct solver loses half the digits on collinear points;
/// the iterative one does not, and re-orthonormalising leaves a valid frame whatever happens.
Matrix3d principal_axes(const Matrix3d& covariance) {
  const double scale = covariance.cwiseAbs().maxCoeff();
  if (!(scale > 0.0) || !std::isfinite(scale)) {
    return Matrix3d::Identity();
  }
  const Eigen::SelfAdjointEigenSolver<Matrix3d> solver(covariance / scale);
  return frame(solver.eigenvectors().col(2), solver.eigenvectors().col(1));
}

/// Collects what a box must enclose along three directions.
class Extents {
 public:
  explicit Extents(const Matrix3d& axes)
      : axes_(axes.cast<float>()), directions_(axes_.cast<double>()) {}

  /// A body that reaches `reach` from a point along each direction.
  void add(const Vector3d& point, const Vector3d& reach) {
    const Vector3d projection = directions_.transpose() * point;
    lower_ = lower_.cwiseMin(projection - reach);
    upper_ = upper_.cwiseMax(projection + reach);
  }
  void add(const Capsule& capsule) {
    add(capsule.p0, Vector3d::Constant(capsule.radius));
    add(capsule.p1, Vector3d::Constant(capsule.radius));
  }
  void add(const Obb& box) {
    const Matrix3d along = (directions_.transpose() * box.axes.cast<double>()).cwiseAbs();
    add(box.center.cast<double>(), along * box.half_extents.cast<double>());
  }

  Obb box() const {
    const Vector3d center = directions_ * (0.5 * (lower_ + upper_));
    const Vector3d half = 0.5 * (upper_ - lower_);
    const double magnitude = center.cwiseAbs().maxCoeff() + half.maxCoeff();
    if (!(magnitude <= RoundedCapsule::largest_magnitude)) {
      return unbounded_box();
    }
    // Pads for the rounded centre and for axes that are orthonormal to single precision only.
    const float padding =
        static_cast<float>(magnitude) * 0x1p-20F + std::numeric_limits<float>::min();
    Obb box;
    box.axes = axes_;
    box.center = center.cast<float>();
    box.half_extents = half.cast<float>().array() + padding;
    return box;
  }

 private:
  Matrix3f axes_;
  Matrix3d directions_;
  Vector3d lower_ = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d upper_ = Vector3d::Constant(-std::numeric_limits<double>::infinity());
};

Obb fitted(const CapsuleRun& run, const Matrix3d& axes) {
  Extents extents(axes);
  for (const Capsule& capsule : run) {
    extents.add(capsule);
  }
  return extents.box();
}

Matrix3d principal_axes(const CapsuleRun& run) {
  Vector3d mean = Vector3d::Zero();
  for (const Capsule& capsule : run) {
    mean += capsule.p0 + capsule.p1;
  }
  mean /= 2.0 * static_cast<double>(run.size);
  Matrix3d covariance = Matrix3d::Zero();
  for (const Capsule& capsule : run) {
    covariance += (capsule.p0 - mean) * (capsule.p0 - mean).transpose() +
                  (capsule.p1 - mean) * (capsule.p1 - mean).transpose();
  }
  return principal_axes(covariance);
}

/// Half the width of a box along a direction given in the other box's frame.
struct Relative {
  Vector3f offset;        // b's centre in a's frame [m]
  Matrix3f rotation;      // b's axes in a's frame
  Matrix3f abs_rotation;  // its magnitudes, padded: near-parallel edges must not separate

  Relative(const Obb& a, const Obb& b)
      : offset(a.axes.transpose() * (b.center - a.center)),
        rotation(a.axes.transpose() * b.axes),
        abs_rotation(rotation.cwiseAbs().array() + 1e-6F) {}

  float gap_along_a(int i, const Obb& a, const Obb& b) const {
    return std::abs(offset[i]) - (a.half_extents[i] + abs_rotation.row(i).dot(b.half_extents));
  }
  float gap_along_b(int j, const Obb& a, const Obb& b) const {
    return std::abs(offset.dot(rotation.col(j))) -
           (abs_rotation.col(j).dot(a.half_extents) + b.half_extents[j]);
  }
};

}  // namespace

void fit(Obb& box, const Capsule& capsule, const NoParameters& /*parameters*/) {
  box = fitted({&capsule, 1}, frame(capsule.p1 - capsule.p0, Vector3d::Zero()));
}

void fit(Obb& box, const CapsuleRun& run, const NoParameters& /*parameters*/) {
  box = fitted(run, principal_axes(run));
}

Obb merge_leaves(const Obb& /*a*/, const Obb& /*b*/, const Capsule& capsule_a,
                 const Capsule& capsule_b) {
  const std::array<Capsule, 2> pair{capsule_a, capsule_b};
  const CapsuleRun run{pair.data(), pair.size()};
  const bool forward = capsule_a.p1 == capsule_b.p0;
  const bool backward = capsule_a.p0 == capsule_b.p1;
  if (!forward && !backward) {
    return fitted(run, principal_axes(run));
  }
  const Vector3d base =
      forward ? Vector3d(capsule_b.p1 - capsule_a.p0) : Vector3d(capsule_a.p1 - capsule_b.p0);
  const Vector3d normal = (capsule_a.p1 - capsule_a.p0)
                              .stableNormalized()
                              .cross((capsule_b.p1 - capsule_b.p0).stableNormalized());
  // A fold closes the triangle's base: then a segment is the longest side.
  const Vector3d longest = base.isZero(0.0) ? Vector3d(capsule_a.p1 - capsule_a.p0) : base;
  return fitted(run, frame(longest, normal));
}

Obb merge(const Obb& a, const Obb& b) {
  if (is_unbounded(a) || is_unbounded(b)) {
    return unbounded_box();
  }
  // The covariance of the 16 corners: of each box's about its centre, and of the two centres.
  Matrix3d covariance = Matrix3d::Zero();
  for (const Obb* box : {&a, &b}) {
    const Matrix3d scaled =
        box->axes.cast<double>() * box->half_extents.cast<double>().asDiagonal();
    covariance += scaled * scaled.transpose();
  }
  const Vector3d half_between = 0.5 * (b.center - a.center).cast<double>();
  covariance += 2.0 * half_between * half_between.transpose();
  Extents extents(principal_axes(covariance));
  extents.add(a);
  extents.add(b);
  return extents.box();
}

bool overlaps(const Obb& a, const Obb& b, float margin) {
  const Relative relative(a, b);
  for (int i = 0; i < 3; ++i) {
    if (relative.gap_along_a(i, a, b) > margin || relative.gap_along_b(i, a, b) > margin) {
      return false;
    }
  }
  // Edges: the axis a_i × b_j is no longer than 1, so the margin along it is no larger than margin.
  const Matrix3f& r = relative.rotation;
  const Matrix3f& abs_r = relative.abs_rotation;
  for (int i = 0; i < 3; ++i) {
    const int i1 = (i + 1) % 3;
    const int i2 = (i + 2) % 3;
    for (int j = 0; j < 3; ++j) {
      const int j1 = (j + 1) % 3;
      const int j2 = (j + 2) % 3;
      const float reach_a = a.half_extents[i1] * abs_r(i2, j) + a.half_extents[i2] * abs_r(i1, j);
      const float reach_b = b.half_extents[j1] * abs_r(i, j2) + b.half_extents[j2] * abs_r(i, j1);
      const float offset = relative.offset[i2] * r(i1, j) - relative.offset[i1] * r(i2, j);
      if (std::abs(offset) > reach_a + reach_b + margin) {
        return false;
      }
    }
  }
  return true;
}

float distance_lower_bound(const Obb& a, const Obb& b) {
  const Relative relative(a, b);
  float widest = 0.0F;
  for (int i = 0; i < 3; ++i) {
    widest = std::max({widest, relative.gap_along_a(i, a, b), relative.gap_along_b(i, a, b)});
  }
  return widest;
}

bool contains(const Obb& box, const Capsule& capsule, const NoParameters& /*parameters*/) {
  const Matrix3d axes = box.axes.cast<double>();
  const Vector3d half = box.half_extents.cast<double>();
  const Vector3d center = box.center.cast<double>();
  for (const Vector3d& point : {capsule.p0, capsule.p1}) {
    const Vector3d reach =
        (axes.transpose() * (point - center)).cwiseAbs().array() + capsule.radius;
    if ((reach.array() > half.array()).any()) {
      return false;
    }
  }
  return true;
}

double volume(const Obb& box, const NoParameters& /*parameters*/) {
  return 8.0 * box.half_extents.cast<double>().prod();
}

Aabb bounding_box(const Obb& box, const NoParameters& /*parameters*/) {
  const Vector3f reach = box.axes.cwiseAbs() * box.half_extents;
  Aabb result;
  for (int axis = 0; axis < 3; ++axis) {
    result.lower[axis] = box.center[axis] - reach[axis];
    result.upper[axis] = box.center[axis] + reach[axis];
  }
  return result;
}

std::vector<SplitAxis> split_axes(const Obb& box, const CapsuleRun& /*run*/,
                                  const NoParameters& /*parameters*/) {
  std::vector<SplitAxis> axes;
  for (int i = 0; i < 3; ++i) {
    const Vector3d direction = box.axes.col(i).cast<double>();
    axes.push_back({direction, direction.dot(box.center.cast<double>()),
                    2.0 * static_cast<double>(box.half_extents[i])});
  }
  std::stable_sort(axes.begin(), axes.end(),
                   [](const SplitAxis& x, const SplitAxis& y) { return x.extent > y.extent; });
  return axes;
}

}  // namespace fiber
