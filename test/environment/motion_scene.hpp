#pragma once

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "src/environment/convex_solids.hpp"
#include "test/environment/random_shapes.hpp"

namespace fiber::test {

inline std::vector<Eigen::Vector3d> random_cable(Random& random, double extent, int segments) {
  std::vector<Eigen::Vector3d> points{random.in_cube(extent)};
  for (int i = 0; i < segments; ++i) {
    points.emplace_back(points.back() + random.in_cube(0.2 * extent));
  }
  return points;
}

inline FiberAssembly cable(const std::vector<Eigen::Vector3d>& points, double radius) {
  return {points, {0, static_cast<std::uint32_t>(points.size())}, {radius}};
}

/// Pose at a time, written otherwise than the library has it.
inline Eigen::Isometry3d pose_at(const Eigen::Isometry3d& before, const Eigen::Isometry3d& after,
                                 double time) {
  const Eigen::AngleAxisd turn(Eigen::Matrix3d(before.linear().transpose() * after.linear()));
  Eigen::Isometry3d pose = before;
  pose.linear() *= Eigen::AngleAxisd(time * turn.angle(), turn.axis()).toRotationMatrix();
  pose.translation() += time * (after.translation() - before.translation());
  return pose;
}

/// Pose at a time of a displacement, written otherwise than the library has it.
inline Eigen::Isometry3d pose_at(const Eigen::Isometry3d& before,
                                 const ObjectDisplacement& displacement, double time) {
  const double half = 0.5 * time * displacement.rotation.norm();
  Eigen::Quaterniond turn = Eigen::Quaterniond::Identity();
  turn.w() = std::cos(half);
  turn.vec() = std::sin(half) * displacement.rotation.normalized();
  Eigen::Isometry3d pose = before;
  pose.linear() = (turn * Eigen::Quaterniond(before.linear())).toRotationMatrix();
  pose.translation() += time * displacement.translation;
  return pose;
}

/// What is asked.
struct MotionScene {
  std::vector<EnvironmentObject> before;
  std::vector<EnvironmentObject> after;
  std::vector<ObjectDisplacement> displacements;  // instead of after, unless it is empty
  FiberAssembly fibers_before;
  FiberAssembly fibers_after;
  MotionOptions options;

  MotionResult ask() const {
    MotionResult result;
    const Environment environment(before);
    if (displacements.empty()) {
      environment.query_motion(fibers_before, fibers_after, Environment(after), options, {},
                               result);
    } else {
      environment.query_motion(fibers_before, fibers_after, displacements, options, {}, result);
    }
    return result;
  }

  Eigen::Isometry3d pose(std::uint32_t object, double time) const {
    const Eigen::Isometry3d& first = before[object].pose;
    return displacements.empty() ? pose_at(first, after[object].pose, time)
                                 : pose_at(first, displacements[object], time);
  }

  /// Of a segment's surface from a shape at a time.
  double gap(std::uint32_t segment, std::uint32_t object, double time) const {
    const auto end = [&](std::uint32_t point) {
      return Eigen::Vector3d((1.0 - time) * fibers_before.points()[point] +
                             time * fibers_after.points()[point]);
    };
    const Eigen::Isometry3d to_shape =
        (pose(object, time) * before[object].shapes[0].pose).inverse(Eigen::Isometry);
    const AxisDistance axis =
        axis_distance(before[object].shapes[0].shape, to_shape * end(segment),
                      to_shape * end(segment + 1), std::numeric_limits<double>::infinity());
    return axis.distance -
           std::max(fibers_before.segment_radius(segment), fibers_after.segment_radius(segment));
  }
};

enum class ObjectMotion { NONE, STRAIGHT, TURNING, DISPLACED };

inline MotionScene random_scene(Random& random, double extent, ObjectMotion motion) {
  MotionScene scene;
  for (const Shape& shape : random_shapes(random, 0.4 * extent)) {
    const std::string name = "object" + std::to_string(scene.before.size());
    const Eigen::Isometry3d in_object = random_pose(random, 0.2 * extent);
    Eigen::Isometry3d pose = random_pose(random, extent);
    scene.before.push_back({name, pose, {{shape, in_object}}});
    if (motion != ObjectMotion::NONE) {
      pose.translation() += random.in_cube(0.5 * extent);
    }
    if (motion == ObjectMotion::TURNING) {
      pose.linear() *=
          Eigen::AngleAxisd(random.uniform(0.0, 3.0), random.direction()).toRotationMatrix();
    }
    scene.after.push_back({name, pose, {{shape, in_object}}});
    if (motion == ObjectMotion::DISPLACED) {
      const double turn = random.chance(0.2) ? 0.0 : std::exp(random.uniform(-8.0, 3.0));
      scene.displacements.push_back({random.in_cube(0.5 * extent), turn * random.direction()});
    }
  }
  const double radius = random.chance(0.3) ? 0.0 : 0.02 * extent * random.uniform(0.0, 1.0);
  std::vector<Eigen::Vector3d> points = random_cable(random, extent, 6);
  scene.fibers_before = cable(points, radius);
  const Eigen::Vector3d common = random.in_cube(extent);
  for (Eigen::Vector3d& point : points) {
    point += common + random.in_cube(0.3 * extent);
  }
  scene.fibers_after = cable(points, random.chance(0.3) ? 1.2 * radius : radius);
  scene.options.margin = random.chance(0.5) ? 0.0 : 0.02 * extent;
  scene.options.tolerance = 1e-6 * extent;
  return scene;
}

/// Of objects that stand still.
inline MotionResult ask(const std::vector<EnvironmentObject>& objects, const FiberAssembly& before,
                        const FiberAssembly& after, const MotionOptions& options,
                        const AllowedPairs& allowed = {}) {
  MotionResult result;
  const Environment environment(objects);
  environment.query_motion(before, after, environment, options, allowed, result);
  return result;
}

/// A straight cable along x at a height, in pieces of 1 cm.
inline std::vector<Eigen::Vector3d> straight_cable(double z, double shift = 0.0) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= 10; ++i) {
    points.emplace_back(shift + 0.01 * i - 0.043, 0.002105, z);
  }
  return points;
}

}  // namespace fiber::test
