#pragma once

#include <algorithm>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// A family of assemblies: a name, and a maker of random members.
struct AssemblyFamily {
  std::string name;
  std::function<FiberAssembly(Random&)> make;
};

/// Collects fibres point by point.
class AssemblyBuilder {
 public:
  void add_point(const Eigen::Vector3d& point) { points_.push_back(point); }
  void end_fiber() { offsets_.push_back(static_cast<std::uint32_t>(points_.size())); }
  void add_fiber(const std::vector<Eigen::Vector3d>& points) {
    points_.insert(points_.end(), points.begin(), points.end());
    end_fiber();
  }
  std::size_t fiber_count() const { return offsets_.size() - 1; }
  std::size_t point_count() const { return points_.size(); }
  FiberAssembly build(std::vector<double> radii) const {
    return {points_, offsets_, std::move(radii)};
  }

 private:
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> offsets_{0};
};

/// A random walk of `segments` steps.
inline std::vector<Eigen::Vector3d> random_walk(Random& random, int segments, double step) {
  std::vector<Eigen::Vector3d> points{random.in_cube()};
  Eigen::Vector3d heading = random.direction();
  for (int i = 0; i < segments; ++i) {
    heading = (heading + 0.5 * random.direction()).normalized();
    points.push_back(points.back() + step * heading);
  }
  return points;
}

/// So many random walks, of one radius.
inline FiberAssembly walks(Random& random, int fibers, int segments, double step, double radius) {
  AssemblyBuilder builder;
  for (int fiber = 0; fiber < fibers; ++fiber) {
    builder.add_fiber(random_walk(random, segments, step));
  }
  return builder.build({radius});
}

/// Fibres of these points, of one radius.
inline FiberAssembly as_fibers(const std::vector<std::vector<Eigen::Vector3d>>& fibers,
                               double radius = 0.0) {
  AssemblyBuilder builder;
  for (const std::vector<Eigen::Vector3d>& points : fibers) {
    builder.add_fiber(points);
  }
  return builder.build({radius});
}

/// The same fibres, moved.
inline FiberAssembly with_points(const FiberAssembly& fibers,
                                 const std::vector<Eigen::Vector3d>& points) {
  FiberAssembly moved = fibers;
  moved.update_points(points);
  return moved;
}

/// The same fibres, every point moved within a cube of its own.
inline FiberAssembly shaken(const FiberAssembly& fibers, double half_edge, Random& random) {
  std::vector<Eigen::Vector3d> points = fibers.points();
  for (Eigen::Vector3d& point : points) {
    point += random.in_cube(half_edge);
  }
  return with_points(fibers, points);
}

/// Leaves points next to no extent along some axes: one axis makes them flat, two make them a
/// needle. What holds segments must hold them whichever axis is the long one.
/// @param first the first of the thin axes; the others follow it
inline void flatten(std::vector<Eigen::Vector3d>& points, int thin_axes, int first) {
  constexpr double thinness = 1e-4;
  for (Eigen::Vector3d& point : points) {
    for (int i = 0; i < thin_axes; ++i) {
      point[(first + i) % 3] *= thinness;
    }
  }
}

/// The same along none, one or two of the axes, whichever they are.
inline void flatten_some(std::vector<Eigen::Vector3d>& points, Random& random) {
  const int thin_axes = random.integer(0, 2);
  flatten(points, thin_axes, random.integer(0, 2));
}

/// [m] How far a point is at most from the first, along one axis.
inline double extent_of(const FiberAssembly& fibers) {
  double extent = 0.0;
  for (const Eigen::Vector3d& point : fibers.points()) {
    extent = std::max(extent, (point - fibers.points().front()).cwiseAbs().maxCoeff());
  }
  return extent;
}

/// First points of all segments.
inline std::vector<std::uint32_t> segments_of(const FiberAssembly& fibers) {
  std::vector<std::uint32_t> segments;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      segments.push_back(i);
    }
  }
  return segments;
}

/// The fibres of an assembly cut to the shortest one's number of points, with its first radius.
inline FiberAssembly equal_fibers(const FiberAssembly& fibers) {
  std::uint32_t shortest = 0xFFFF'FFFFU;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    shortest = std::min(shortest, fibers.offsets()[fiber + 1] - fibers.offsets()[fiber]);
  }
  AssemblyBuilder builder;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const auto begin = fibers.points().begin() + fibers.offsets()[fiber];
    builder.add_fiber({begin, begin + shortest});
  }
  return builder.build({fibers.radii().front()});
}

/// Walks that are flat, or a needle.
inline FiberAssembly thin_walks(Random& random, int thin_axes) {
  const double radius = random.chance(0.3) ? 0.0 : random.uniform(0.0, 0.05);
  const FiberAssembly fibers =
      walks(random, random.integer(2, 8), random.integer(1, 40), 0.1, radius);
  std::vector<Eigen::Vector3d> points = fibers.points();
  flatten(points, thin_axes, random.integer(0, 2));
  return with_points(fibers, points);
}

/// Clusters of walks that are small beside what is between them.
inline FiberAssembly clustered_walks(Random& random) {
  constexpr double size = 1e-4;
  AssemblyBuilder builder;
  for (int cluster = 0; cluster < 3; ++cluster) {
    const Eigen::Vector3d centre = random.in_cube();
    for (int fiber = 0; fiber < 3; ++fiber) {
      std::vector<Eigen::Vector3d> points = random_walk(random, random.integer(1, 20), 0.1);
      for (Eigen::Vector3d& point : points) {
        point = centre + size * point;
      }
      builder.add_fiber(points);
    }
  }
  return builder.build({random.uniform(0.0, 0.05) * size});
}

/// Ordinary and hard assemblies, small enough for brute force.
inline std::vector<AssemblyFamily> assembly_families() {
  const auto walks = [](Random& random, double scale, const Eigen::Vector3d& centre) {
    AssemblyBuilder builder;
    const int fibers = random.integer(1, 8);
    for (int f = 0; f < fibers; ++f) {
      for (const Eigen::Vector3d& p : random_walk(random, random.integer(1, 40), 0.1)) {
        builder.add_point(centre + scale * p);
      }
      builder.end_fiber();
    }
    return builder;
  };
  const Eigen::Vector3d origin = Eigen::Vector3d::Zero();
  return {
      {"walks", [=](Random& r) { return walks(r, 1.0, origin).build({r.uniform(0.0, 0.05)}); }},
      {"radius_per_fiber",
       [=](Random& r) {
         const AssemblyBuilder builder = walks(r, 1.0, origin);
         std::vector<double> radii(builder.fiber_count());
         for (double& radius : radii) {
           radius = r.uniform(0.0, 0.1);
         }
         return builder.build(radii);
       }},
      {"radius_per_point",
       [=](Random& r) {
         const AssemblyBuilder builder = walks(r, 1.0, origin);
         std::vector<double> radii(builder.point_count());
         for (double& radius : radii) {
           radius = r.uniform(0.0, 0.1);
         }
         return builder.build(radii);
       }},
      {"radius_zero", [=](Random& r) { return walks(r, 1.0, origin).build({0.0}); }},
      {"radius_beyond_scene", [=](Random& r) { return walks(r, 1.0, origin).build({50.0}); }},
      {"far_away",
       [=](Random& r) {
         return walks(r, 1e-3, 1e6 * r.direction()).build({r.uniform(0.0, 1e-4)});
       }},
      {"tiny", [=](Random& r) { return walks(r, 1e-20, origin).build({1e-22}); }},
      {"denormal", [=](Random& r) { return walks(r, 1e-310, origin).build({1e-312}); }},
      {"beyond_float", [=](Random& r) { return walks(r, 1e60, origin).build({1e58}); }},
      {"single_segment",
       [](Random& r) {
         const Eigen::Vector3d start = r.in_cube();
         return as_fibers({{start, r.in_cube()}}, 0.1);
       }},
      {"parallel",
       [](Random& r) {
         AssemblyBuilder builder;
         const Eigen::Vector3d u = r.direction();
         for (int f = 0; f < 6; ++f) {
           const Eigen::Vector3d start = 0.1 * r.in_cube();
           std::vector<Eigen::Vector3d> points;
           for (int i = 0; i < 10; ++i) {
             points.emplace_back(start + 0.1 * i * u);
           }
           builder.add_fiber(points);
         }
         return builder.build({0.02});
       }},
      {"collinear_on_grid",
       [](Random& r) {
         AssemblyBuilder builder;
         for (int f = 0; f < 5; ++f) {
           const int start = r.integer(0, 6);
           std::vector<Eigen::Vector3d> points;
           for (int i = 0; i < 6; ++i) {
             points.emplace_back(start + i, 0.0, 0.0);
           }
           builder.add_fiber(points);
         }
         return builder.build({r.chance(0.5) ? 0.0 : 0.5});
       }},
      {"grid_touching",  // distances exactly equal to the sum of radii, ties everywhere
       [](Random& r) {
         AssemblyBuilder builder;
         for (int f = 0; f < 10; ++f) {
           std::vector<Eigen::Vector3d> points{
               Eigen::Vector3d(r.integer(0, 3), r.integer(0, 3), r.integer(0, 3))};
           for (int i = 0; i < 5; ++i) {
             Eigen::Vector3d next = points.back();
             next[r.integer(0, 2)] += r.chance(0.5) ? 1.0 : -1.0;
             points.push_back(next);
           }
           builder.add_fiber(points);
         }
         return builder.build({0.5});
       }},
      {"coincident",
       [](Random& r) {
         const std::vector<Eigen::Vector3d> fiber = random_walk(r, 8, 0.1);
         return as_fibers(std::vector(6, fiber), r.chance(0.5) ? 0.0 : 0.01);
       }},
      {"zero_length",
       [](Random& r) {
         AssemblyBuilder builder;
         for (int f = 0; f < 5; ++f) {
           const Eigen::Vector3d point = 0.1 * r.in_cube();
           builder.add_fiber(std::vector<Eigen::Vector3d>(4, point));
         }
         return builder.build({0.02});
       }},
      {"all_in_one_point",
       [](Random& r) {
         const std::vector<Eigen::Vector3d> fiber(5, r.in_cube());
         return as_fibers(std::vector(5, fiber));
       }},
      {"folded_back",
       [](Random& r) {
         const Eigen::Vector3d u = r.direction();
         std::vector<Eigen::Vector3d> points;
         for (int i = 0; i < 30; ++i) {
           points.emplace_back((i % 10 < 5 ? i % 5 : 5 - i % 5) * 0.1 * u + 1e-3 * i * r.in_cube());
         }
         return as_fibers({points}, 0.01);
       }},
      {"long_and_short",
       [](Random& r) {
         AssemblyBuilder builder;
         builder.add_fiber({Eigen::Vector3d(-500.0, 0.0, 0.0), Eigen::Vector3d(500.0, 0.0, 0.0)});
         for (int f = 0; f < 5; ++f) {
           const Eigen::Vector3d point = r.in_cube(1e-5);
           builder.add_fiber({point, point + 1e-6 * r.direction()});
         }
         return builder.build({1e-6});
       }},
      {"flat", [](Random& r) { return thin_walks(r, 1); }},
      {"needle", [](Random& r) { return thin_walks(r, 2); }},
      {"clustered", clustered_walks},
      {"no_fibers", [](Random& /*r*/) { return FiberAssembly(); }},
  };
}

}  // namespace fiber::test
