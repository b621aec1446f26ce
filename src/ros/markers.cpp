#include "fiber_proximity/ros/markers.hpp"

#include <cstdio>
#include <string>

#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/marker_scale.hpp"
#include "fiber_proximity/ros/palette.hpp"
#include "fiber_proximity/ros/tube_mesh.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

std_msgs::ColorRGBA color_of(std::uint32_t fiber) {
  const auto& [r, g, b] = fiber_color(fiber);
  return color(r, g, b);
}

std_msgs::ColorRGBA contact_color(const fiber::Contact& contact) {
  return contact.distance < 0.0 ? color(0.95F, 0.15F, 0.12F) : color(1.0F, 0.70F, 0.10F);
}

Vector3d middle_of(const fiber::Contact& contact) {
  return 0.5 * contact.point_a + 0.5 * contact.point_b;
}

void append_box(const fiber::NodeBox& box, std::vector<geometry_msgs::Point>& lines) {
  const auto corner = [&box](unsigned bits) {
    return to_message(Vector3d((bits & 1U) != 0 ? box.upper.x() : box.lower.x(),
                               (bits & 2U) != 0 ? box.upper.y() : box.lower.y(),
                               (bits & 4U) != 0 ? box.upper.z() : box.lower.z()));
  };
  for (const unsigned axis : {1U, 2U, 4U}) {
    for (unsigned bits = 0; bits < 8; ++bits) {
      if ((bits & axis) == 0) {
        lines.push_back(corner(bits));
        lines.push_back(corner(bits | axis));
      }
    }
  }
}

}  // namespace

std::string distance_text(double distance) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", 1e3 * distance);
  return text.data();
}

std::string cost_text(const std::string& kernel, double seconds, double error, bool is_complete) {
  std::array<char, 128> text{};
  std::snprintf(text.data(), text.size(), "%s: %.2f ms, error <= %.1e m%s", kernel.c_str(),
                1e3 * seconds, error, is_complete ? "" : ", cut off");
  return text.data();
}

void MarkerBuilder::draw_tubes(const fiber::FiberAssembly& fibers, Canvas& canvas) {
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    Marker& marker = canvas.add(FIBERS, Marker::TRIANGLE_LIST);
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
    marker.color = color_of(fiber);
    append_tube(fibers, fiber, marker.points);
  }
}

void MarkerBuilder::draw_lines(const fiber::FiberAssembly& fibers, double width, Canvas& canvas) {
  Marker& marker = canvas.add(FIBERS, Marker::LINE_LIST);
  marker.scale.x = width;
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      marker.points.push_back(to_message(fibers.points()[i]));
      marker.points.push_back(to_message(fibers.points()[i + 1]));
      marker.colors.insert(marker.colors.end(), 2, color_of(fiber));
    }
  }
}

void MarkerBuilder::draw_contacts(const std::vector<fiber::Contact>& contacts, double thickness,
                                  Canvas& canvas) {
  Marker& marker = canvas.add(CONTACTS, Marker::SPHERE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = thickness;
  for (const fiber::Contact& contact : contacts) {
    marker.points.push_back(to_message(middle_of(contact)));
    marker.colors.push_back(contact_color(contact));
  }
}

void MarkerBuilder::draw_normals(const std::vector<fiber::Contact>& contacts, double thickness,
                                 Canvas& canvas) {
  Marker& marker = canvas.add(NORMALS, Marker::LINE_LIST);
  marker.scale.x = 0.08 * thickness;
  for (const fiber::Contact& contact : contacts) {
    const Vector3d start = middle_of(contact);
    marker.points.push_back(to_message(start));
    marker.points.push_back(to_message(start + 1.2 * thickness * contact.normal));
    marker.colors.insert(marker.colors.end(), 2, contact_color(contact));
  }
}

void MarkerBuilder::draw_nearest(const fiber::Contact& minimum, double extent, Canvas& canvas) {
  Marker& line = canvas.add(NEAREST, Marker::LINE_LIST);
  line.scale.x = 0.004 * extent;
  line.points = {to_message(minimum.point_a), to_message(minimum.point_b)};

  Marker& text = canvas.add(NEAREST_TEXT, Marker::TEXT_VIEW_FACING);
  text.scale.z = 0.035 * extent;
  text.pose.position = to_message(middle_of(minimum) + 0.07 * extent * Vector3d::UnitZ());
  text.text = distance_text(minimum.distance);
}

void MarkerBuilder::draw_boxes(const std::vector<fiber::NodeBox>& boxes, double extent,
                               Canvas& canvas) {
  Marker& marker = canvas.add(BOXES, Marker::LINE_LIST);
  marker.scale.x = 0.001 * extent;
  marker.color = color(0.75F, 0.85F, 1.0F, 0.35F);
  for (const fiber::NodeBox& box : boxes) {
    append_box(box, marker.points);
  }
}

void MarkerBuilder::draw_cost(const std::string& cost, const Vector3d& top, double extent,
                              Canvas& canvas) {
  Marker& text = canvas.add(COST, Marker::TEXT_VIEW_FACING);
  text.scale.z = 0.035 * extent;
  text.pose.position = to_message(top + 0.15 * extent * Vector3d::UnitZ());
  text.text = cost;
}

void MarkerBuilder::build(const std_msgs::Header& header, const Drawing& drawing,
                          const MarkerOptions& options, visualization_msgs::MarkerArray& markers) {
  const auto& [fibers, contacts, minimum, boxes, cost, crossings] = drawing;
  const MarkerScale scale(fibers);
  // Thicker than the fibres, to be seen where two of them hide the point of contact.
  const double thickness = 3.0 * scale.thickest;
  static const Canvas::Names names{"fibers",       "contacts", "normals", "nearest",
                                   "nearest_text", "cost",     "boxes",   "crossings"};
  Canvas canvas(header, names, markers);
  if (options.show_fibers && fibers.segment_count() > most_tube_segments) {
    draw_lines(fibers, 2.0 * scale.thinnest, canvas);
  } else if (options.show_fibers) {
    draw_tubes(fibers, canvas);
  }
  if (options.show_contacts && !contacts.empty()) {
    draw_contacts(contacts, thickness, canvas);
    draw_normals(contacts, thickness, canvas);
  }
  if (options.show_nearest && minimum != nullptr) {
    draw_nearest(*minimum, scale.extent, canvas);
  }
  if (options.show_cost) {
    draw_cost(cost, scale.top, scale.extent, canvas);
  }
  if (options.show_boxes && !boxes.empty()) {
    draw_boxes(boxes, scale.extent, canvas);
  }
  if (options.show_crossings && crossings != nullptr && !crossings->crossings.empty()) {
    draw_crossings(fibers, *crossings, thickness, canvas.add(CROSSINGS, Marker::LINE_LIST));
  }
  canvas.finish(drawn_);
}

}  // namespace fiber_proximity_ros
