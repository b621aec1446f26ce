#pragma once

#include <cmath>
#include <cstdint>
#include <functional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "test/support/assemblies.hpp"

namespace fiber::test {

using Curve = std::vector<Eigen::Vector3d>;

constexpr double turn = 6.28318530717958647692;

/// A closed curve of that many points; the last is joined to the first.
inline Curve sampled(int count, const std::function<Eigen::Vector3d(double)>& at) {
  Curve curve;
  for (int i = 0; i < count; ++i) {
    curve.push_back(at(turn * (i + 0.3) / count));
  }
  return curve;
}

inline Curve circle(int count, double radius = 1.0) {
  return sampled(count, [radius](double t) {
    return Eigen::Vector3d(radius * std::cos(t), radius * std::sin(t), 0.0);
  });
}

/// Left-handed: three crossings of sign −1, seen along z.
inline Curve trefoil(int count) {
  return sampled(count, [](double t) {
    return Eigen::Vector3d(std::sin(t) + 2.0 * std::sin(2.0 * t),
                           std::cos(t) - 2.0 * std::cos(2.0 * t), -std::sin(3.0 * t));
  });
}

/// Four crossings along z, two of each sign.
inline Curve figure_eight(int count) {
  return sampled(count, [](double t) {
    const double r = 2.0 + std::cos(2.0 * t);
    return Eigen::Vector3d(r * std::cos(3.0 * t), r * std::sin(3.0 * t), std::sin(4.0 * t));
  });
}

/// One of the two components of the torus link T(2, 2n), each once along and n times around the
/// torus.
inline Curve torus_link(int count, int n, bool second) {
  return sampled(count, [n, second](double t) {
    const double angle = n * t + (second ? turn / 2.0 : 0.0);
    const double r = 2.0 + std::cos(angle);
    return Eigen::Vector3d(r * std::cos(t), r * std::sin(t), -std::sin(angle));
  });
}

/// The component of the Whitehead link that crosses itself; the other is circle(n, 1.3).
inline Curve whitehead_eight() {
  return {{0, 0, 1},  {1, 1, -1}, {3, 0, 0},  {1, -1, 1},
          {0, 0, -1}, {-1, 1, 1}, {-3, 0, 0}, {-1, -1, -1}};
}

inline Curve random_curve(Random& random, int count, double half_edge = 1.0) {
  Curve curve;
  for (int i = 0; i < count; ++i) {
    curve.push_back(random.in_cube(half_edge));
  }
  return curve;
}

/// Points with whole coordinates: few enough to meet, to line up and to hide each other.
inline Curve grid_curve(Random& random, int count, int half_edge) {
  Curve curve;
  for (int i = 0; i < count; ++i) {
    curve.emplace_back(random.integer(-half_edge, half_edge), random.integer(-half_edge, half_edge),
                       random.integer(-half_edge, half_edge));
  }
  return curve;
}

/// The same points with the first once more at the end.
inline Curve closed(Curve curve) {
  curve.push_back(curve.front());
  return curve;
}

inline Curve mapped(const Curve& curve,
                    const std::function<Eigen::Vector3d(const Eigen::Vector3d&)>& map) {
  Curve result;
  for (const Eigen::Vector3d& point : curve) {
    result.push_back(map(point));
  }
  return result;
}

inline Curve reversed(const Curve& curve) { return {curve.rbegin(), curve.rend()}; }

inline Curve mirrored(const Curve& curve) {
  return mapped(curve,
                [](const Eigen::Vector3d& p) { return Eigen::Vector3d(p.x(), p.y(), -p.z()); });
}

}  // namespace fiber::test
