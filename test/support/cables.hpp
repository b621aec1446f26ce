#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/geometry/segment_distance.hpp"
#include "test/support/curves.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// A cable of a radius of 1.
struct Cable {
  std::string name;
  Curve points;
  double radius = 1.0;

  /// Of any size and place.
  FiberAssembly fibers(double scale = 1.0) const {
    Curve scaled = points;
    for (Eigen::Vector3d& point : scaled) {
      point *= scale;
    }
    return {scaled, {0, static_cast<std::uint32_t>(points.size())}, {scale * radius}};
  }
};

/// Points of a curve with a parameter from 0 to 1.
template <class At>
Curve along(int count, const At& at) {
  Curve points;
  for (int i = 0; i < count; ++i) {
    points.push_back(at(static_cast<double>(i) / (count - 1)));
  }
  return points;
}

/// Every point off by up to half a radius, in any direction.
inline Curve noisy(Curve points, Random& random) {
  for (Eigen::Vector3d& point : points) {
    point += 0.5 * std::cbrt(random.uniform(0.0, 1.0)) * random.direction();
  }
  return points;
}

/// Cables without a loop: straight ones and gently curved ones, exact and noisy, of that many
/// points and this length in radii.
inline std::vector<Cable> loopless_cables(int count, double length, Random& random) {
  using Eigen::Vector3d;
  const Vector3d direction = random.direction();
  const double bend = random.uniform(0.2, 0.49) * turn;  // of the arc, in all
  const double phase = random.uniform(0.0, turn);
  const auto straight = [&](double s) -> Vector3d { return length * s * direction; };
  const auto arc = [&](double s) -> Vector3d {
    return length / bend *
           Vector3d(std::cos(bend * s), std::sin(bend * s), 0.1 * std::sin(phase) * bend * s);
  };
  // Slopes of up to a half.
  const auto wave = [&](double s) -> Vector3d {
    const double x = length * s;
    const double waves = 3.0 * turn / length;
    return {x, 0.5 / waves * std::sin(waves * x), 0.3 / waves * std::cos(waves * x + phase)};
  };
  std::vector<Cable> cables{{"straight", along(count, straight)},
                            {"arc", along(count, arc)},
                            {"wave", along(count, wave)}};
  for (int i = 0; i < 3; ++i) {
    cables.push_back({"noisy " + cables[i].name, noisy(cables[i].points, random)});
  }
  for (Cable& cable : cables) {
    cable.name += ", " + std::to_string(count) + " points, " + std::to_string(length) + " radii";
  }
  return cables;
}

/// Two strands that touch, of this length in radii, with a half circle between them; `count`
/// points, ends and corners among them.
inline Cable hairpin(double length, int count) {
  using Eigen::Vector3d;
  const int of_strand = std::max(2, (count - 1) / 2);
  Curve points =
      along(of_strand, [&](double s) { return Vector3d(length * (s - 1.0), -1.0, 0.0); });
  if (count > 20) {
    for (const double angle : {-0.3, -0.15, 0.0, 0.15, 0.3}) {
      points.emplace_back(std::cos(angle * turn / 2.0), std::sin(angle * turn / 2.0), 0.0);
    }
  }
  const Curve back = along(of_strand, [&](double s) { return Vector3d(-length * s, 1.0, 0.0); });
  points.insert(points.end(), back.begin(), back.end());
  return {"hairpin of " + std::to_string(length) + " radii, " + std::to_string(points.size()) +
              " points",
          points};
}

/// A coil around a cylinder, its axis at `radius` from the cylinder's, turns that touch.
inline Cable coil(double radius, double turns, int points_per_turn) {
  const int count = static_cast<int>(turns * points_per_turn) + 1;
  // Turns of a polygon lie over each other as those of a helix do: 2 apart.
  const Curve points = along(count, [&](double s) {
    const double angle = s * (count - 1) / points_per_turn * turn;
    return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 2.0 / turn * angle);
  });
  return {"coil at " + std::to_string(radius) + " radii of " + std::to_string(turns) + " turns, " +
              std::to_string(points_per_turn) + " points a turn",
          points};
}

/// A ring whose ends touch.
inline Cable open_ring(double radius, int count) {
  const double gap = 2.0 * std::asin(1.0 / radius);
  return {"ring at " + std::to_string(radius) + " radii, " + std::to_string(count) + " points",
          along(count, [&](double s) {
            const double angle = (turn - gap) * s;
            return Eigen::Vector3d(radius * std::cos(angle), radius * std::sin(angle), 0.0);
          })};
}

/// An open overhand knot, pulled until its strands touch: a trefoil that is thick enough.
inline Cable tight_knot(int count) {
  const Curve points = along(count, [](double s) {
    const double t = turn * (0.02 + 0.96 * s);
    return Eigen::Vector3d(std::sin(t) + 2.0 * std::sin(2.0 * t),
                           std::cos(t) - 2.0 * std::cos(2.0 * t), -std::sin(3.0 * t));
  });
  // Of strands that are not near along the knot.
  double nearest = 2.0;
  for (int i = 0; i + 1 < count; ++i) {
    for (int j = i + std::max(2, count / 8); j + 1 < count; ++j) {
      const bool beside_the_cut = count - (j - i) < count / 8;
      nearest =
          beside_the_cut
              ? nearest
              : std::min(
                    nearest,
                    segment_distance(points[i], points[i + 1], points[j], points[j + 1]).distance);
    }
  }
  return {"knot, " + std::to_string(count) + " points", points, nearest / 2.0};
}

}  // namespace fiber::test
