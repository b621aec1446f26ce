#include "src/paper/bounds/kdop.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>

namespace fiber {
namespace {

using Eigen::Vector3d;
using Polygon = std::vector<Vector3d>;

/// The points x with normal·x <= offset.
struct HalfSpace {
  Vector3d normal;
  double offset = 0.0;
};

/// Sutherland–Hodgman: what of a convex polygon lies in a half space.
Polygon clip(const Polygon& polygon, const HalfSpace& half_space) {
  Polygon result;
  for (std::size_t i = 0; i < polygon.size(); ++i) {
    const Vector3d& current = polygon[i];
    const Vector3d& next = polygon[(i + 1) % polygon.size()];
    const double here = half_space.normal.dot(current) - half_space.offset;
    const double there = half_space.normal.dot(next) - half_space.offset;
    if (here <= 0.0) {
      result.push_back(current);
    }
    if ((here < 0.0 && there > 0.0) || (here > 0.0 && there < 0.0)) {
      result.push_back(current + (here / (here - there)) * (next - current));
    }
  }
  return result;
}

/// A square on the half space's boundary, larger than the polytope.
Polygon square_on(const HalfSpace& half_space, double half_edge) {
  const Vector3d u = half_space.normal.unitOrthogonal();
  const Vector3d v = half_space.normal.cross(u);
  const Vector3d center = half_space.offset * half_space.normal;
  return {center + half_edge * (u + v), center + half_edge * (v - u), center - half_edge * (u + v),
          center + half_edge * (u - v)};
}

double area(const Polygon& polygon) {
  Vector3d doubled = Vector3d::Zero();
  for (std::size_t i = 2; i < polygon.size(); ++i) {
    doubled += (polygon[i - 1] - polygon[0]).cross(polygon[i] - polygon[0]);
  }
  return 0.5 * doubled.norm();
}

}  // namespace

PolytopeMeasure measure_polytope(const std::vector<Vector3d>& directions,
                                 const std::vector<double>& lower,
                                 const std::vector<double>& upper) {
  // About the point in the middle of the first three slabs, where offsets are small.
  Eigen::Matrix3d first;
  Vector3d middles;
  double largest = 0.0;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    if (i < 3) {
      first.row(static_cast<Eigen::Index>(i)) = directions[i].transpose();
      middles[static_cast<Eigen::Index>(i)] = 0.5 * (lower[i] + upper[i]);
    }
    largest = std::max(largest, upper[i] - lower[i]);
  }
  const Vector3d center = first.fullPivLu().solve(middles);

  std::vector<HalfSpace> half_spaces;
  for (std::size_t i = 0; i < directions.size(); ++i) {
    const double shift = directions[i].dot(center);
    half_spaces.push_back({directions[i], upper[i] - shift});
    half_spaces.push_back({-directions[i], shift - lower[i]});
  }
  PolytopeMeasure measure;
  Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
  Vector3d high = -low;
  for (std::size_t face = 0; face < half_spaces.size(); ++face) {
    Polygon polygon = square_on(half_spaces[face], 100.0 * largest);
    for (std::size_t other = 0; other < half_spaces.size() && !polygon.empty(); ++other) {
      if (other != face) {
        polygon = clip(polygon, half_spaces[other]);
      }
    }
    measure.volume += area(polygon) * half_spaces[face].offset / 3.0;
    for (const Vector3d& vertex : polygon) {
      low = low.cwiseMin(center + vertex);
      high = high.cwiseMax(center + vertex);
    }
  }
  for (int axis = 0; axis < 3; ++axis) {
    measure.box.lower[axis] = static_cast<float>(low[axis]);
    measure.box.upper[axis] = static_cast<float>(high[axis]);
  }
  return measure;
}

}  // namespace fiber
