#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <vector>

namespace fiber::test {

/// A trefoil knot whose ends lead away, along x.
inline std::vector<Eigen::Vector3d> open_trefoil(double size, int edges) {
  std::vector<Eigen::Vector3d> points;
  constexpr double gap = 0.35;  // of the closed knot, left out where it is outermost [rad]
  for (int i = 0; i <= edges; ++i) {
    const double t = M_PI / 6.0 + gap + (2.0 * M_PI - 2.0 * gap) * i / edges;
    points.emplace_back(size * Eigen::Vector3d(std::sin(t) + 2.0 * std::sin(2.0 * t),
                                               std::cos(t) - 2.0 * std::cos(2.0 * t),
                                               -std::sin(3.0 * t)));
  }
  const double edge = (points[1] - points[0]).norm();
  const Eigen::Vector3d out = (points.front() + points.back()).normalized();
  const Eigen::Vector3d apart = (points.front() - points.back()).normalized();
  for (int i = 0; i < 6; ++i) {
    points.insert(points.begin(), points.front() + edge * (out + apart).normalized());
    points.push_back(points.back() + edge * (out - apart).normalized());
  }
  return points;
}

}  // namespace fiber::test
