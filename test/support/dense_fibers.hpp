#pragma once

#include <cmath>
#include <vector>

#include "test/support/assemblies.hpp"

namespace fiber::test {

/// Points along a curve over [0, 1].
template <class Curve>
std::vector<Eigen::Vector3d> sampled(int segments, const Curve& curve) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    points.push_back(curve(static_cast<double>(i) / segments));
  }
  return points;
}

/// Fibres that need fewer segments than they have: dense, and about a metre large.
inline std::vector<AssemblyFamily> dense_families() {
  using Eigen::Vector3d;
  constexpr double turn = 6.283185307179586;
  const auto wave = [](Random& r, int segments) {
    const Vector3d start = 0.3 * r.in_cube();
    const Vector3d u = r.direction();
    const Vector3d v = 0.1 * r.direction();
    return sampled(segments,
                   [=](double x) { return Vector3d(start + x * u + std::sin(turn * x) * v); });
  };
  return {
      {"smooth_cables",
       [=](Random& r) {
         AssemblyBuilder builder;
         for (int f = 0; f < 4; ++f) {
           builder.add_fiber(wave(r, r.integer(1, 120)));
         }
         return builder.build({r.uniform(0.001, 0.03)});
       }},
      {"cones",  // every point thinner than the one before, and noise on that
       [=](Random& r) {
         AssemblyBuilder builder;
         std::vector<double> radii;
         for (int f = 0; f < 4; ++f) {
           builder.add_fiber(wave(r, 60));
           for (int i = 0; i <= 60; ++i) {
             radii.push_back(0.03 - 0.0004 * i + r.uniform(0.0, 0.001));
           }
         }
         return builder.build(radii);
       }},
      {"zigzags",
       [](Random& r) {
         AssemblyBuilder builder;
         for (int f = 0; f < 4; ++f) {
           const Vector3d start = 0.1 * r.in_cube();
           const Vector3d u = r.direction();
           const double noise = r.uniform(0.0, 0.01);
           std::vector<Vector3d> points;
           for (int i = 0; i < 50; ++i) {
             points.emplace_back(start + 0.02 * i * u + noise * r.in_cube());
           }
           builder.add_fiber(points);
         }
         return builder.build({0.005});
       }},
      {"fold",  // there and back within a diameter, densely
       [](Random& r) {
         AssemblyBuilder builder;
         const double apart = r.uniform(0.0, 0.05);
         builder.add_fiber(sampled(120, [=](double x) {
           const double along = x < 0.5 ? x : 1.0 - x;
           return Vector3d(along, x < 0.5 ? 0.0 : apart, 0.002 * std::sin(9.0 * x));
         }));
         return builder.build({0.01});
       }},
      {"hairpins",  // thin, with a sharp or a blunt turn every six segments
       [](Random& r) {
         AssemblyBuilder builder;
         for (int f = 0; f < 4; ++f) {
           std::vector<Vector3d> points{0.3 * r.in_cube()};
           Vector3d u = r.direction();
           const double noise = r.uniform(0.0, 0.01);
           for (int i = 0; i < 36; ++i) {
             u = i % 6 == 5 ? (r.uniform(-1.2, 0.5) * u + 0.5 * r.direction()).normalized() : u;
             points.emplace_back(points.back() + r.uniform(0.01, 0.05) * u + noise * r.in_cube());
           }
           builder.add_fiber(points);
         }
         return builder.build({0.0005});
       }},
      {"knot",  // a trefoil
       [](Random& r) {
         AssemblyBuilder builder;
         const double size = r.uniform(0.05, 0.3);
         builder.add_fiber(sampled(150, [=](double x) {
           const double a = turn * x;
           return Vector3d(size * Vector3d(std::sin(a) + 2.0 * std::sin(2.0 * a),
                                           std::cos(a) - 2.0 * std::cos(2.0 * a),
                                           -std::sin(3.0 * a)));
         }));
         return builder.build({0.04});
       }},
  };
}

}  // namespace fiber::test
