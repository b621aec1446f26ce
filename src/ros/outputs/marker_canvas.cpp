#include "src/ros/outputs/marker_canvas.hpp"

#include <algorithm>
#include <array>
#include <cstdio>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/outputs/tube_mesh.hpp"

namespace fiber_proximity_ros {

using Eigen::Vector3d;
using visualization_msgs::Marker;

std_msgs::ColorRGBA color(const Rgb& rgb, float a) {
  std_msgs::ColorRGBA result;
  result.r = rgb[0];
  result.g = rgb[1];
  result.b = rgb[2];
  result.a = a;
  return result;
}

std::string distance_text(double distance) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", 1e3 * distance);
  return text.data();
}

MarkerScale::MarkerScale(const fiber::FiberAssembly& fibers, const std::string& frame)
    : up(is_optical_frame(frame) ? Vector3d(-Vector3d::UnitY()) : Vector3d(Vector3d::UnitZ())) {
  for (const double radius : fibers.radii()) {
    thickest = std::max(thickest, radius);
    thinnest = std::min(thinnest, radius);
  }
  thickest = std::max(thickest, hairline_radius);
  thinnest = std::max(thinnest, hairline_radius);
  if (fibers.points().empty()) {
    return;
  }
  for (const Vector3d& point : fibers.points()) {
    box.extend(point);
  }
  extent = std::max(box.sizes().maxCoeff(), thickest);
  const Vector3d half = 0.5 * box.max() - 0.5 * box.min();
  top = box.min() + half + std::abs(up.dot(half)) * up;
}

Vector3d MarkerScale::front() const {
  return up.y() != 0.0 ? Vector3d(-Vector3d::UnitZ()) : Vector3d(-Vector3d::UnitY());
}

Vector3d MarkerScale::below_in_front(double distance) const {
  const double depth = box.isEmpty() ? 0.0 : std::abs(front().dot(box.sizes()));
  return bottom() + (0.5 * depth + distance) * front() - distance * up;
}

Marker& MarkerCanvas::add(const std::string& ns, int type) {
  Marker& marker = take(ns, counts_[ns]++, Marker::ADD);
  marker.type = type;
  return marker;
}

Marker& MarkerCanvas::add_text(const std::string& ns, double height, const Vector3d& position,
                               const std::string& text) {
  Marker& marker = add(ns, Marker::TEXT_VIEW_FACING);
  marker.scale.z = height;
  marker.pose.position = to_message(position);
  marker.text = text;
  texts_.push_back({position, height, text.size()});
  return marker;
}

void MarkerCanvas::add_leader(const std::string& ns, const MarkerScale& scale,
                              const Vector3d& point, const Vector3d& end) {
  Marker& line = add(ns, Marker::LINE_LIST);
  line.scale.x = 0.002 * scale.extent;
  line.color = color({1.0F, 1.0F, 1.0F}, 0.8F);
  line.points = {to_message(point), to_message(end)};
}

/// Each line is a marker of its own, for its colour; all are at one place, where empty lines above
/// and below move each to its own, from wherever one looks.
void MarkerCanvas::add_legend(const std::vector<LegendLine>& legend, const MarkerScale& scale) {
  const double height = 0.03 * scale.extent;
  const double half_block = 0.5 * static_cast<double>(legend.size()) * height;
  const Vector3d position = scale.below_in_front(0.1 * scale.extent + half_block);
  for (std::size_t line = 0; line < legend.size(); ++line) {
    const std::string text =
        std::string(line, '\n') + legend[line].text + std::string(legend.size() - 1 - line, '\n');
    add_text("legend", height, position, text).color = color(legend[line].color);
  }
}

void MarkerCanvas::finish(Counts& drawn) {
  for (const auto& [ns, count] : drawn) {
    for (std::int32_t id = counts_[ns]; id < count; ++id) {
      take(ns, id, Marker::DELETE);
    }
  }
  drawn = counts_;
  markers_.resize(used_);
}

Marker& MarkerCanvas::take(const std::string& ns, std::int32_t id, int action) {
  if (used_ == markers_.size()) {
    markers_.emplace_back();
  }
  Marker& marker = markers_[used_++];
  marker.header = header_;
  marker.ns = ns;
  marker.id = id;
  marker.action = action;
  marker.type = 0;
  marker.pose = geometry_msgs::Pose();
  marker.pose.orientation.w = 1.0;
  marker.scale = geometry_msgs::Vector3();
  marker.color = color({1.0F, 1.0F, 1.0F});
  marker.points.clear();
  marker.colors.clear();
  marker.text.clear();
  return marker;
}

void append_line(const Vector3d& from, const Vector3d& to, const std_msgs::ColorRGBA& color,
                 Marker& lines) {
  lines.points.push_back(to_message(from));
  lines.points.push_back(to_message(to));
  lines.colors.insert(lines.colors.end(), 2, color);
}

}  // namespace fiber_proximity_ros
