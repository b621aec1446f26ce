#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// The contents of two volumes.
struct HardRuns {
  std::vector<Capsule> a;
  std::vector<Capsule> b;
};

/// Contents that are hard to bound in the same way; of about a metre, with radii of 0.
struct RunFamily {
  std::string name;
  std::function<HardRuns(Random&)> make;
};

/// 0, or any power of ten from the last digit of a double on.
inline double tiny(Random& random) {
  return random.chance(0.2) ? 0.0 : std::pow(10.0, random.uniform(-17.0, -1.0));
}

/// A small turn about any axis.
inline Eigen::Matrix3d small_turn(Random& random) {
  return Eigen::AngleAxisd(tiny(random), random.direction()).toRotationMatrix();
}

/// Segments that join two of the points each, whichever.
inline std::vector<Capsule> joined(Random& random, const std::vector<Eigen::Vector3d>& points) {
  const auto any = [&] { return points[random.integer(0, static_cast<int>(points.size()) - 1)]; };
  std::vector<Capsule> run(random.integer(1, 8));
  for (Capsule& capsule : run) {
    capsule = {any(), any(), 0.0};
  }
  return run;
}

/// The four long edges of a box: their end points are its corners.
inline std::vector<Capsule> box_edges(const Eigen::Vector3d& half, const Eigen::Matrix3d& frame) {
  std::vector<Capsule> run;
  for (const double y : {-half.y(), half.y()}) {
    for (const double z : {-half.z(), half.z()}) {
      run.push_back(
          {frame * Eigen::Vector3d(-half.x(), y, z), frame * Eigen::Vector3d(half.x(), y, z), 0.0});
    }
  }
  return run;
}

/// Boxes whose edges are nearly parallel; some with principal axes that are not determined.
inline HardRuns near_parallel_boxes(Random& random) {
  const Eigen::Matrix3d frame =
      Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.direction()).toRotationMatrix();
  const auto half = [&] {
    return random.chance(0.2) ? Eigen::Vector3d::Constant(0.5).eval()
                              : Eigen::Vector3d(random.uniform(0.5, 1.0), random.uniform(0.1, 0.5),
                                                random.uniform(0.01, 0.1));
  };
  return {box_edges(half(), frame), box_edges(half(), small_turn(random) * frame)};
}

inline HardRuns near_parallel_needles(Random& random) {
  const Eigen::Vector3d u = random.direction();
  const Eigen::Vector3d v = small_turn(random) * u;
  return {{{-u, u, 0.0}}, {{-v, random.uniform(-1.0, 1.0) * v, 0.0}}};
}

/// Points on one line, but for what is tiny.
inline HardRuns collinear_runs(Random& random) {
  const Eigen::Vector3d u = random.chance(0.2) ? Eigen::Vector3d::UnitX() : random.direction();
  const double off = tiny(random);
  const auto points = [&] {
    std::vector<Eigen::Vector3d> result;
    for (int i = 0; i < 6; ++i) {
      result.emplace_back(random.uniform(-1.0, 1.0) * u + off * random.in_cube());
    }
    return result;
  };
  return {joined(random, points()), joined(random, points())};
}

inline HardRuns coplanar_runs(Random& random) {
  const Eigen::Vector3d u = random.direction();
  const Eigen::Vector3d v = random.direction();
  const auto points = [&] {
    std::vector<Eigen::Vector3d> result;
    for (int i = 0; i < 8; ++i) {
      result.emplace_back(random.uniform(-1.0, 1.0) * u + random.uniform(-1.0, 1.0) * v);
    }
    return result;
  };
  return {joined(random, points()), joined(random, points())};
}

/// Points of a sphere.
struct Cospherical {
  std::vector<Eigen::Vector3d> points;
  double radius = 0.5;  // [m]
};

/// Points (±x, ±y, ±z) and their permutations, on the sphere to the last bit; or rounded.
inline Cospherical cospherical(Random& random) {
  Cospherical result;
  const bool exact = random.chance(0.5);
  const Eigen::Vector3d centre = random.in_cube();
  const Eigen::Vector3d corner =
      0x1p-4 * Eigen::Vector3d(random.integer(0, 8), random.integer(0, 8), random.integer(1, 8));
  for (int i = 0; i < 16; ++i) {
    if (!exact) {
      result.points.emplace_back(centre + result.radius * random.direction());
      continue;
    }
    const int first = random.integer(0, 2);
    Eigen::Vector3d point;
    for (int axis = 0; axis < 3; ++axis) {
      point[axis] = (random.chance(0.5) ? 1.0 : -1.0) * corner[(first + axis) % 3];
    }
    result.points.push_back(point);
  }
  result.radius = exact ? corner.norm() : result.radius;
  return result;
}

inline HardRuns cospherical_runs(Random& random) {
  return {joined(random, cospherical(random).points), joined(random, cospherical(random).points)};
}

/// All in one place, but for what is tiny.
inline HardRuns coincident_runs(Random& random) {
  const double off = tiny(random);
  const auto run = [&] {
    const Capsule one{random.in_cube(), random.in_cube(), 0.0};
    std::vector<Capsule> result(random.integer(2, 8), one);
    const bool no_length = random.chance(0.5);
    for (Capsule& capsule : result) {
      capsule.p0 += off * random.in_cube();
      capsule.p1 = no_length ? capsule.p0 : Eigen::Vector3d(capsule.p1 + off * random.in_cube());
    }
    return result;
  };
  return {run(), run()};
}

inline HardRuns single_points(Random& random) {
  const Eigen::Vector3d p = random.in_cube();
  const Eigen::Vector3d q = random.in_cube();
  return {{{p, p, 0.0}}, {{q, q, 0.0}}};
}

/// Segments of a metre and of less than a micrometre in one volume.
inline HardRuns needles_and_dust(Random& random) {
  const auto run = [&] {
    const Eigen::Vector3d u = random.direction();
    std::vector<Capsule> result{{-u, u, 0.0}};
    for (int i = 0; i < 4; ++i) {
      const Eigen::Vector3d p = random.uniform(-1.0, 1.0) * u;
      result.push_back({p, p + 1e-6 * tiny(random) * random.direction(), 0.0});
    }
    return result;
  };
  return {run(), run()};
}

inline const std::vector<RunFamily>& run_families() {
  static const std::vector<RunFamily> families{
      {"near_parallel_boxes", near_parallel_boxes},
      {"near_parallel_needles", near_parallel_needles},
      {"collinear", collinear_runs},
      {"coplanar", coplanar_runs},
      {"cospherical", cospherical_runs},
      {"coincident", coincident_runs},
      {"single_points", single_points},
      {"needles_and_dust", needles_and_dust},
  };
  return families;
}

}  // namespace fiber::test
