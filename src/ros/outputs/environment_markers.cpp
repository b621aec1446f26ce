#include "src/ros/outputs/environment_markers.hpp"

#include <algorithm>
#include <cassert>
#include <vector>

#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/environment/obstacle_parts.hpp"
#include "src/ros/outputs/markers.hpp"
#include "src/ros/outputs/shape_marker.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using fiber::WorldBox;
using visualization_msgs::Marker;

bool is_link(const fiber::EnvironmentObject& object) {
  return object.name.rfind(fiber::robot_prefix, 0) == 0;
}

/// What is near the fibres. Each is looked at only if its box is near.
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
  bool contains(const fiber::Shape& shape, const Eigen::Isometry3d& pose) const {
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

std_msgs::ColorRGBA distance_color(double distance, double free_distance) {
  assert(free_distance > 0.0);
  const double part = 2.0 * std::clamp(distance / free_distance, 0.0, 1.0);
  return color(part <= 1.0 ? mix(palette::penetrating, palette::nearby, part)
                           : mix(palette::nearby, palette::distant, part - 1.0));
}

void EnvironmentMarkers::draw_objects(const EnvironmentDrawing& drawing, double reach,
                                      Canvas& canvas) {
  const Neighbourhood near(drawing.fibers, reach);
  for (const fiber::EnvironmentObject& object : drawing.objects) {
    for (const fiber::PlacedShape& placed : object.shapes) {
      const Eigen::Isometry3d pose = object.pose * placed.pose;
      if (near.contains(placed.shape, pose)) {
        Marker& marker = canvas.add(is_link(object) ? ROBOT : OBSTACLES, Marker::CUBE);
        marker.color =
            is_link(object) ? color(0.75F, 0.80F, 0.90F, 0.45F) : color(0.55F, 0.62F, 0.75F, 0.45F);
        draw_shape(placed.shape, pose, near.around(), marker);
      }
    }
  }
}

void EnvironmentMarkers::draw_distances(const std::vector<fiber::Contact>& contacts,
                                        double free_distance, double thickness, Canvas& canvas) {
  Marker& lines = canvas.add(DISTANCES, Marker::LINE_LIST);
  lines.scale.x = 0.15 * thickness;
  for (const fiber::Contact& contact : contacts) {
    lines.points.push_back(to_message(contact.point_a));
    lines.points.push_back(to_message(contact.point_b));
    lines.colors.insert(lines.colors.end(), 2, distance_color(contact.distance, free_distance));
  }
  Marker& points = canvas.add(POINTS, Marker::SPHERE_LIST);
  points.scale.x = points.scale.y = points.scale.z = 0.6 * thickness;
  for (const fiber::Contact& contact : contacts) {
    points.points.push_back(to_message(contact.point_b));
    points.colors.push_back(distance_color(contact.distance, free_distance));
  }
}

void EnvironmentMarkers::draw_nearest(const EnvironmentDrawing& drawing, double free_distance,
                                      const MarkerScale& scale, Canvas& canvas) {
  const fiber::Contact& minimum = *drawing.minimum;
  Marker& line = canvas.add(NEAREST, Marker::LINE_LIST);
  line.scale.x = 0.004 * scale.extent;
  line.color = distance_color(minimum.distance, free_distance);
  line.points = {to_message(minimum.point_a), to_message(minimum.point_b)};

  Marker& text = canvas.add(TEXT, Marker::TEXT_VIEW_FACING);
  text.scale.z = 0.035 * scale.extent;
  // Above all fibres, as beside the point the object would often hide it.
  Vector3d place = minimum.point_b;
  const double below_top = std::max(0.0, scale.up.dot(scale.top - place));
  place += (below_top + 0.07 * scale.extent) * scale.up;
  text.pose.position = to_message(place);
  text.text = drawing.objects[minimum.fiber_b].name + ": " + distance_text(minimum.distance);
}

void EnvironmentMarkers::append(const std_msgs::Header& header, const EnvironmentDrawing& drawing,
                                const EnvironmentMarkerOptions& options,
                                visualization_msgs::MarkerArray& markers) {
  static const Canvas::Names names{"obstacles",
                                   "robot",
                                   "environment_distances",
                                   "environment_points",
                                   "environment_nearest",
                                   "environment_nearest_text"};
  const MarkerScale scale(drawing.fibers, header.frame_id);
  Canvas canvas(header, names, markers, markers.markers.size());
  if (options.show_objects && drawing.fibers.fiber_count() > 0) {
    draw_objects(drawing, options.reach, canvas);
  }
  if (options.show_distances && !drawing.contacts.empty()) {
    draw_distances(drawing.contacts, options.free_distance, 3.0 * scale.thickest, canvas);
  }
  if (options.show_nearest && drawing.minimum != nullptr) {
    draw_nearest(drawing, options.free_distance, scale, canvas);
  }
  canvas.finish(drawn_);
}

}  // namespace fiber_proximity_ros
