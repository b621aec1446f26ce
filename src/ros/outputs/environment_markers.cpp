#include "src/ros/outputs/environment_markers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <utility>

#include "fiber_proximity/environment/occupancy_octree.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/environment/triangle_mesh.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/geometry/smallest_rotation.hpp"
#include "src/ros/outputs/label_place.hpp"
#include "src/ros/outputs/tube_mesh.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Isometry3d;
using Eigen::Vector3d;
using fiber::WorldBox;
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
  std::pair<double, double> distances(const WorldBox& box) const {
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
  ShapeDrawer(const Isometry3d& pose, const WorldBox& around, Marker& marker)
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
      if (is_near(*mesh, triangle) && ++drawn <= max_mesh_triangles) {
        for (const std::uint32_t corner : triangle) {
          marker_.points.push_back(to_message(mesh->vertices()[corner]));
        }
      }
    }
    if (drawn > max_mesh_triangles) {
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
    WorldBox box;
    for (const std::uint32_t corner : triangle) {
      box.extend(pose_ * mesh.vertices()[corner]);
    }
    return box.intersects(around_);
  }

  const Isometry3d& pose_;
  const WorldBox& around_;
  Marker& marker_;
};

bool is_link(const fiber::EnvironmentObject& object) {
  return object.name.rfind(fiber::robot_prefix, 0) == 0;
}

/// Tells what is near the fibres. A fibre is examined only if its box is near.
class Neighbourhood {
 public:
  Neighbourhood(const fiber::FiberAssembly& fibers, double reach)
      : fibers_(fibers), reach_(reach + fibers.largest_radius()), boxes_(fibers.fiber_count()) {
    for (std::uint32_t fiber = 0; fiber < boxes_.size(); ++fiber) {
      for (std::uint32_t i = fibers.offsets()[fiber]; i < fibers.offsets()[fiber + 1]; ++i) {
        boxes_[fiber].extend(fibers.points()[i]);
      }
      around_.extend(boxes_[fiber]);
    }
    around_.min().array() -= reach_;
    around_.max().array() += reach_;
  }

  /// All that is near reaches into this box.
  const WorldBox& around() const { return around_; }

  /// Bounded shapes are near by their boxes, planes by that of all fibres.
  bool contains(const fiber::Shape& shape, const Isometry3d& pose) const {
    if (!reaches_into(around_, shape, pose)) {
      return false;
    }
    const WorldBox box = fiber::world_box(shape, pose);
    for (std::uint32_t fiber = 0; fiber < boxes_.size(); ++fiber) {
      if (!fiber::is_bounded(shape) || contains(box, fiber)) {
        return true;
      }
    }
    return false;
  }

 private:
  bool contains(const WorldBox& box, std::uint32_t fiber) const {
    if (box.exteriorDistance(boxes_[fiber]) > reach_) {
      return false;
    }
    const std::vector<Vector3d>& points = fibers_.points();
    for (std::uint32_t i = fibers_.offsets()[fiber]; i + 1 < fibers_.offsets()[fiber + 1]; ++i) {
      const WorldBox segment(points[i].cwiseMin(points[i + 1]), points[i].cwiseMax(points[i + 1]));
      if (box.exteriorDistance(segment) <= reach_) {
        return true;
      }
    }
    return false;
  }

  const fiber::FiberAssembly& fibers_;
  double reach_;                 // from the axes [m]
  std::vector<WorldBox> boxes_;  // around each fibre's axis [m]
  WorldBox around_;
};

}  // namespace

bool reaches_into(const WorldBox& box, const fiber::Shape& shape, const Isometry3d& pose) {
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

void draw_shape(const fiber::Shape& shape, const Isometry3d& pose, const WorldBox& around,
                Marker& marker) {
  assert(!around.isEmpty());
  std::visit(ShapeDrawer(pose, around, marker), shape);
}

std_msgs::ColorRGBA distance_color(double distance, double free_distance) {
  assert(free_distance > 0.0);
  const double part = 2.0 * std::clamp(distance / free_distance, 0.0, 1.0);
  return color(part <= 1.0 ? mix(palette::penetrating, palette::nearby, part)
                           : mix(palette::nearby, palette::distant, part - 1.0));
}

void draw_objects(const fiber::FiberAssembly& fibers,
                  const std::vector<fiber::EnvironmentObject>& objects, double reach,
                  MarkerCanvas& canvas) {
  const Neighbourhood near(fibers, reach);
  for (const fiber::EnvironmentObject& object : objects) {
    for (const fiber::PlacedShape& placed : object.shapes) {
      const Isometry3d pose = object.pose * placed.pose;
      if (near.contains(placed.shape, pose)) {
        Marker& marker = canvas.add(is_link(object) ? "robot" : "obstacles", Marker::CUBE);
        marker.color =
            color(is_link(object) ? Rgb{0.75F, 0.80F, 0.90F} : Rgb{0.55F, 0.62F, 0.75F}, 0.45F);
        draw_shape(placed.shape, pose, near.around(), marker);
      }
    }
  }
}

void draw_distances(const std::vector<fiber::Contact>& contacts, double free_distance,
                    double thickness, MarkerCanvas& canvas) {
  Marker& lines = canvas.add("environment_distances", Marker::LINE_LIST);
  lines.scale.x = 0.15 * thickness;
  for (const fiber::Contact& contact : contacts) {
    append_line(contact.point_a, contact.point_b, distance_color(contact.distance, free_distance),
                lines);
  }
  Marker& points = canvas.add("environment_points", Marker::SPHERE_LIST);
  points.scale.x = points.scale.y = points.scale.z = 0.6 * thickness;
  for (const fiber::Contact& contact : contacts) {
    points.points.push_back(to_message(contact.point_b));
    points.colors.push_back(distance_color(contact.distance, free_distance));
  }
}

void draw_nearest_object(const fiber::FiberAssembly& fibers, const EnvironmentDrawing& drawing,
                         double free_distance, const MarkerScale& scale, MarkerCanvas& canvas) {
  const fiber::Contact& minimum = *drawing.minimum;
  // At the object, on the side where its surface is, as its inside would hide the text; a little
  // upwards, as what it stands on would.
  const std::string text =
      drawing.objects[minimum.fiber_b].name + ": " + distance_text(minimum.distance);
  const Vector3d outwards = (0.6 * scale.up - minimum.normal).stableNormalized();
  const double height = 0.035 * scale.extent;
  const double gap = 1.5 * height;
  const Label label{minimum.point_b, outwards,       gap,           height,
                    text.size(),     minimum.normal, canvas.texts()};
  draw_closest_pair(fibers, scale, minimum, distance_color(minimum.distance, free_distance), label,
                    text, "environment_nearest", canvas);
}

}  // namespace fiber_proximity_ros
