#include "src/ros/outputs/shape_marker.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>
#include <vector>

#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/occupancy_octree.hpp"
#include "src/geometry/smallest_rotation.hpp"
#include "src/ros/outputs/tube_mesh.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr int circle_sides = 32;  // of what is round
constexpr int arc_steps = 8;      // from pole to rim of a half sphere

/// Distance from the z axis, and height [m].
using ProfilePoint = std::pair<double, double>;

/// Appends the triangles of the surface that a profile sweeps about z, from the pole below to the
/// one above, counter-clockwise from outside.
void append_revolved(const std::vector<ProfilePoint>& profile,
                     std::vector<geometry_msgs::Point>& triangles) {
  const auto at = [](const ProfilePoint& point, int side) {
    const double angle = 2.0 * M_PI * side / circle_sides;
    return to_message(
        Vector3d(point.first * std::cos(angle), point.first * std::sin(angle), point.second));
  };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int side = 0; side < circle_sides; ++side) {
      const int next = (side + 1) % circle_sides;
      if (profile[i].first > 0.0) {
        triangles.insert(triangles.end(),
                         {at(profile[i], side), at(profile[i], next), at(profile[i + 1], next)});
      }
      if (profile[i + 1].first > 0.0) {
        triangles.insert(triangles.end(), {at(profile[i], side), at(profile[i + 1], next),
                                           at(profile[i + 1], side)});
      }
    }
  }
}

std::vector<ProfilePoint> capsule_profile(double radius, double length) {
  std::vector<ProfilePoint> profile;
  for (const double end : {-1.0, 1.0}) {
    for (int step = 0; step <= arc_steps; ++step) {
      const double angle = 0.5 * M_PI * (end < 0.0 ? arc_steps - step : step) / arc_steps;
      const bool is_pole = step == (end < 0.0 ? 0 : arc_steps);
      profile.emplace_back(is_pole ? 0.0 : radius * std::cos(angle),
                           end * (0.5 * length + radius * std::sin(angle)));
    }
  }
  return profile;
}

/// A plane or the surface of a half-space: all points p with normal·p = height.
struct Sheet {
  template <class Flat>
  Sheet(const Flat& flat, const Isometry3d& pose)
      : normal(pose.linear() * flat.normal),
        height(normal.dot(pose * Vector3d(flat.offset * flat.normal))) {}

  /// Signed distances of the nearest and the furthest corner of a box [m].
  std::pair<double, double> distances(const fiber::WorldBox& box) const {
    const double middle = normal.dot(box.center()) - height;
    const double half = 0.5 * normal.cwiseAbs().dot(box.sizes());
    return {middle - half, middle + half};
  }

  Vector3d normal;
  double height;
};

double visible(double length) { return std::max(length, 2.0 * hairline_radius); }

class ShapeDrawer {
 public:
  ShapeDrawer(const Isometry3d& pose, const fiber::WorldBox& around, Marker& marker)
      : pose_(pose), around_(around), marker_(marker) {}

  void operator()(const fiber::BoxShape& box) { draw_solid(Marker::CUBE, box.size, pose_); }
  void operator()(const fiber::SphereShape& sphere) {
    draw_solid(Marker::SPHERE, Vector3d::Constant(2.0 * sphere.radius), pose_);
  }
  void operator()(const fiber::CylinderShape& cylinder) {
    const double width = 2.0 * cylinder.radius;
    draw_solid(Marker::CYLINDER, {width, width, cylinder.height}, pose_);
  }
  void operator()(const fiber::ConeShape& cone) {
    begin_triangles();
    const double radius = std::max(cone.radius, hairline_radius);
    const double half = 0.5 * visible(cone.height);
    append_revolved({{0.0, -half}, {radius, -half}, {0.0, half}}, marker_.points);
  }
  void operator()(const fiber::CapsuleShape& capsule) {
    begin_triangles();
    append_revolved(capsule_profile(std::max(capsule.radius, hairline_radius), capsule.length),
                    marker_.points);
  }
  void operator()(const fiber::HalfSpaceShape& half_space) {
    draw_sheet(Sheet(half_space, pose_), -0.5);  // its upper side is the surface
  }
  void operator()(const fiber::PlaneShape& plane) { draw_sheet(Sheet(plane, pose_), 0.0); }
  void operator()(const std::shared_ptr<const fiber::TriangleMesh>& mesh) {
    begin_triangles();
    std::size_t drawn = 0;
    for (const fiber::TriangleMesh::Triangle& triangle : mesh->triangles()) {
      if (is_near(*mesh, triangle) && ++drawn <= most_mesh_triangles) {
        for (const std::uint32_t corner : triangle) {
          marker_.points.push_back(to_message(mesh->vertices()[corner]));
        }
      }
    }
    if (drawn > most_mesh_triangles) {
      marker_.points.clear();
      draw_solid(Marker::CUBE, mesh->box().sizes(),
                 pose_ * Eigen::Translation3d(mesh->box().center()));
    }
  }
  void operator()(const std::shared_ptr<const fiber::OccupancyOctree>& octree) {
    draw_solid(Marker::CUBE_LIST, Vector3d::Constant(octree->resolution()), pose_);
    const double half_diagonal = 0.5 * std::sqrt(3.0) * octree->resolution();
    for (const Vector3d& centre : octree->centres()) {
      if (around_.exteriorDistance(Vector3d(pose_ * centre)) <= half_diagonal) {
        marker_.points.push_back(to_message(centre));
      }
    }
  }

 private:
  void draw_solid(int type, const Vector3d& size, const Isometry3d& pose) {
    marker_.type = type;
    marker_.scale = to_vector_message(size.unaryExpr(&visible));
    marker_.pose = to_message(pose);
  }

  void begin_triangles() { draw_solid(Marker::TRIANGLE_LIST, Vector3d::Ones(), pose_); }

  /// @param shift of its middle along the normal, as a part of its thickness
  void draw_sheet(const Sheet& sheet, double shift) {
    const double width = around_.sizes().norm();
    const double thickness = visible(0.002 * width);
    Isometry3d middle(fiber::smallest_rotation(Vector3d::UnitZ(), sheet.normal));
    const Vector3d centre = around_.center();
    middle.translation() =
        centre + (sheet.height - sheet.normal.dot(centre) + shift * thickness) * sheet.normal;
    draw_solid(Marker::CUBE, {width, width, thickness}, middle);
  }

  bool is_near(const fiber::TriangleMesh& mesh,
               const fiber::TriangleMesh::Triangle& triangle) const {
    fiber::WorldBox box;
    for (const std::uint32_t corner : triangle) {
      box.extend(pose_ * mesh.vertices()[corner]);
    }
    return box.intersects(around_);
  }

  const Isometry3d& pose_;
  const fiber::WorldBox& around_;
  Marker& marker_;
};

}  // namespace

bool reaches_into(const fiber::WorldBox& box, const fiber::Shape& shape, const Isometry3d& pose) {
  assert(!box.isEmpty());
  if (const auto* half_space = std::get_if<fiber::HalfSpaceShape>(&shape)) {
    return Sheet(*half_space, pose).distances(box).first <= 0.0;
  }
  if (const auto* plane = std::get_if<fiber::PlaneShape>(&shape)) {
    const auto [nearest, furthest] = Sheet(*plane, pose).distances(box);
    return nearest <= 0.0 && furthest >= 0.0;
  }
  return fiber::world_box(shape, pose).intersects(box);
}

void draw_shape(const fiber::Shape& shape, const Isometry3d& pose, const fiber::WorldBox& around,
                Marker& marker) {
  assert(!around.isEmpty());
  std::visit(ShapeDrawer(pose, around, marker), shape);
}

}  // namespace fiber_proximity_ros
