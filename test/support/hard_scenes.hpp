#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/assemblies.hpp"

namespace fiber::test {

constexpr double pi = 3.14159265358979323846;

inline double segment_gap(const std::vector<Eigen::Vector3d>& points, std::size_t first,
                          std::size_t second) {
  return fiber::segment_distance(points[first], points[first + 1], points[second],
                                 points[second + 1])
      .distance;
}

inline void turn_at_random(std::vector<Eigen::Vector3d>& points, Random& random) {
  const Eigen::Matrix3d rotation =
      Eigen::AngleAxisd(random.uniform(0.0, pi), random.direction()).toRotationMatrix();
  for (Eigen::Vector3d& point : points) {
    point = rotation * point;
  }
}

/// There and back over the same points; every third time beside them, by ever so little.
inline FiberAssembly folded_fiber(Random& random) {
  std::vector<Eigen::Vector3d> way = random_walk(random, 8, 0.1);
  AssemblyBuilder builder;
  for (int fold = 0; fold < 9; ++fold) {
    const double aside = fold % 3 == 2 ? std::pow(10.0, random.uniform(-16.0, -2.0)) : 0.0;
    for (const Eigen::Vector3d& point : way) {
      builder.add_point(point + aside * random.in_cube());
    }
    std::reverse(way.begin(), way.end());
  }
  builder.end_fiber();
  return builder.build({random.chance(0.5) ? 0.0 : 0.01});
}

inline FiberAssembly coincident_fibers(Random& random) {
  const std::vector<Eigen::Vector3d> fiber = random_walk(random, 4, 0.1);
  return as_fibers(std::vector(25, fiber), random.chance(0.5) ? 0.0 : 0.01);
}

/// A trefoil around a ring: two strands that wind around each other and touch all along, as they
/// would if it were pulled tight.
inline FiberAssembly tight_knot(Random& random) {
  constexpr int segments = 100;
  constexpr double half_gap = 0.1;  // [m] of the strands, around a ring of 1 m
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    const double around = 4.0 * pi * (i % segments) / segments;
    const double out = 1.0 + half_gap * std::cos(1.5 * around);
    points.emplace_back(out * std::cos(around), out * std::sin(around),
                        half_gap * std::sin(1.5 * around));
  }
  turn_at_random(points, random);
  double gap = std::numeric_limits<double>::infinity();
  for (std::size_t i = 0; i < segments / 2; ++i) {
    gap = std::min(gap, segment_gap(points, i, i + segments / 2));
  }
  return as_fibers({points}, 0.5 * gap);
}

/// A helix with its pitch, across the wire, for a diameter: turns touch but for the last digits.
inline FiberAssembly close_wound_coil(Random& random) {
  constexpr int per_turn = 12;
  constexpr int turns = 8;
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= per_turn * turns; ++i) {
    const double angle = 2.0 * pi * (i % per_turn) / per_turn;
    points.emplace_back(0.05 * std::cos(angle), 0.05 * std::sin(angle), 0.02 * i / per_turn);
  }
  turn_at_random(points, random);
  return as_fibers({points}, 0.5 * segment_gap(points, 0, per_turn));
}

/// Radii of 0 and whole numbers for coordinates: segments touch exactly where they cross.
inline FiberAssembly crossing_threads(Random& random) {
  const auto whole = [&](int most) {
    return Eigen::Vector3d(random.integer(-most, most), random.integer(-most, most),
                           random.integer(-most, most));
  };
  AssemblyBuilder builder;
  for (int star = 0; star < 12; ++star) {
    const Eigen::Vector3d centre = whole(6);
    for (int ray = 0; ray < 4; ++ray) {
      const Eigen::Vector3d half = whole(3);
      builder.add_fiber({centre - half, centre, centre + half});
    }
  }
  return builder.build({0.0});
}

/// A segment of a kilometre and many of a micrometre, about as far from it as they are thick.
inline FiberAssembly kilometre_and_micrometres(Random& random) {
  constexpr double radius = 1e-6;  // [m]
  const Eigen::Vector3d along = random.direction();
  AssemblyBuilder builder;
  builder.add_fiber({-500.0 * along, 500.0 * along});
  for (int grain = 0; grain < 60; ++grain) {
    const double place = random.chance(0.5) ? 0.0 : random.uniform(-500.0, 500.0);
    const Eigen::Vector3d across = along.cross(random.direction()).normalized();
    const Eigen::Vector3d start = place * along + 2.0 * radius * across;
    builder.add_fiber({start, start + 1e-6 * random.direction()});
  }
  return builder.build({radius});
}

inline FiberAssembly millimetres_at(double away, Random& random) {
  const Eigen::Vector3d centre = away * random.direction();
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < 8; ++fiber) {
    for (const Eigen::Vector3d& point : random_walk(random, 12, 0.1)) {
      builder.add_point(centre + 1e-3 * point);
    }
    builder.end_fiber();
  }
  return builder.build({random.uniform(0.0, 2e-4)});
}

/// Whole scenes that are hard on arithmetic, of about a hundred segments.
inline std::vector<AssemblyFamily> hard_scenes() {
  return {
      {"folded_fiber", folded_fiber},
      {"coincident_fibers", coincident_fibers},
      {"tight_knot", tight_knot},
      {"close_wound_coil", close_wound_coil},
      {"crossing_threads", crossing_threads},
      {"kilometre_and_micrometres", kilometre_and_micrometres},
      {"millimetres_at_1e6", [](Random& random) { return millimetres_at(1e6, random); }},
      {"millimetres_at_1e8", [](Random& random) { return millimetres_at(1e8, random); }},
  };
}

}  // namespace fiber::test
