#include "src/ros/outputs/markers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <cstdio>
#include <map>
#include <string>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/palette.hpp"
#include "src/ros/outputs/tube_mesh.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

std_msgs::ColorRGBA color_of(std::uint32_t fiber) { return color(fiber_color(fiber)); }

std_msgs::ColorRGBA contact_color(const fiber::Contact& contact) {
  return color(contact.distance < 0.0 ? palette::penetrating : palette::within_margin);
}

Vector3d middle_of(const fiber::Contact& contact) {
  return 0.5 * contact.point_a + 0.5 * contact.point_b;
}

double radius_of(const fiber::FiberAssembly& fibers, std::uint32_t fiber, std::uint32_t segment) {
  return fibers.capsule(fibers.offsets()[fiber] + segment).radius;
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

double disc_size(const fiber::FiberAssembly& fibers, const fiber::Contact& contact,
                 double largest) {
  const double thinner =
      std::max(hairline_radius, std::min(radius_of(fibers, contact.fiber_a, contact.segment_a),
                                         radius_of(fibers, contact.fiber_b, contact.segment_b)));
  return contact.distance <= thinner ? largest : 1.5 * thinner;
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

/// A SPHERE_LIST has one size for all: sizes are rounded down, by a sixth at most.
void MarkerBuilder::draw_contacts(const fiber::FiberAssembly& fibers,
                                  const std::vector<fiber::Contact>& contacts, double largest,
                                  Canvas& canvas) {
  constexpr double steps_per_halving = 4.0;
  std::map<int, std::vector<const fiber::Contact*>> by_size;
  for (const fiber::Contact& contact : contacts) {
    const double halvings = std::log2(largest / disc_size(fibers, contact, largest));
    by_size[static_cast<int>(std::ceil(steps_per_halving * halvings - 1e-9))].push_back(&contact);
  }
  for (const auto& [steps, alike] : by_size) {
    Marker& marker = canvas.add(CONTACTS, Marker::SPHERE_LIST);
    marker.scale.x = marker.scale.y = marker.scale.z =
        largest * std::exp2(-steps / steps_per_halving);
    for (const fiber::Contact* contact : alike) {
      marker.points.push_back(to_message(middle_of(*contact)));
      marker.colors.push_back(contact_color(*contact));
    }
  }
}

void MarkerBuilder::draw_normals(const fiber::FiberAssembly& fibers,
                                 const std::vector<fiber::Contact>& contacts, double largest,
                                 Canvas& canvas) {
  Marker& marker = canvas.add(NORMALS, Marker::LINE_LIST);
  marker.scale.x = 0.08 * largest;
  for (const fiber::Contact& contact : contacts) {
    const Vector3d start = middle_of(contact);
    const double length = 1.2 * disc_size(fibers, contact, largest);
    marker.points.push_back(to_message(start));
    marker.points.push_back(to_message(start + length * contact.normal));
    marker.colors.insert(marker.colors.end(), 2, contact_color(contact));
  }
}

void MarkerBuilder::draw_passed(const std::vector<fiber::Contact>& contacts, double largest,
                                Canvas& canvas) {
  Marker& marker = canvas.add(PASSED, Marker::SPHERE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = largest;
  marker.color = color(palette::passed);
  for (const fiber::Contact& contact : contacts) {
    marker.points.push_back(to_message(middle_of(contact)));
  }
}

void MarkerBuilder::draw_nearest(const fiber::Contact& minimum, const MarkerScale& scale,
                                 Canvas& canvas) {
  Marker& line = canvas.add(NEAREST, Marker::LINE_LIST);
  line.scale.x = 0.004 * scale.extent;
  line.color = color(palette::nearest);
  line.points = {to_message(minimum.point_a), to_message(minimum.point_b)};

  Marker& text = canvas.add(NEAREST_TEXT, Marker::TEXT_VIEW_FACING);
  text.scale.z = 0.035 * scale.extent;
  text.pose.position = to_message(middle_of(minimum) + 0.07 * scale.extent * scale.up);
  text.text = distance_text(minimum.distance);
}

void MarkerBuilder::draw_boxes(const std::vector<fiber::NodeBox>& boxes, double extent,
                               Canvas& canvas) {
  Marker& marker = canvas.add(BOXES, Marker::LINE_LIST);
  marker.scale.x = 0.001 * extent;
  marker.color = color(palette::boxes, 0.35F);
  for (const fiber::NodeBox& box : boxes) {
    append_box(box, marker.points);
  }
}

void MarkerBuilder::draw_cost(const std::string& cost, const MarkerScale& scale, Canvas& canvas) {
  Marker& text = canvas.add(COST, Marker::TEXT_VIEW_FACING);
  text.scale.z = 0.035 * scale.extent;
  text.pose.position = to_message(scale.top + 0.15 * scale.extent * scale.up);
  text.text = cost;
}

void MarkerBuilder::draw_names(const fiber::FiberAssembly& fibers,
                               const std::vector<std::string>& names, const MarkerScale& scale,
                               Canvas& canvas) {
  assert(names.size() == fibers.fiber_count());
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    Marker& text = canvas.add(NAMES, Marker::TEXT_VIEW_FACING);
    text.scale.z = 0.035 * scale.extent;
    const std::uint32_t first = fibers.offsets()[fiber];
    const Vector3d& end = fibers.points()[first];
    const Vector3d& middle = fibers.points()[(first + fibers.offsets()[fiber + 1]) / 2];
    const Vector3d outward = (end - middle).stableNormalized();
    text.pose.position = to_message(end + scale.extent * (0.1 * outward + 0.05 * scale.up));
    text.color = color(mix({1.0F, 1.0F, 1.0F}, fiber_color(fiber), 0.5));
    text.text = names[fiber];
  }
}

/// x red, y green, z blue, as everywhere in rviz; between the legend and the names of the ends.
void MarkerBuilder::draw_axes(const MarkerScale& scale, Canvas& canvas) {
  const double length = 0.12 * scale.extent;
  Marker& marker = canvas.add(AXES, Marker::LINE_LIST);
  marker.scale.x = 0.06 * length;
  const Vector3d origin = scale.bottom() - 0.12 * scale.extent * scale.up -
                          0.35 * scale.box.sizes().x() * Vector3d::UnitX();
  for (int axis = 0; axis < 3; ++axis) {
    Rgb rgb{0.2F, 0.2F, 0.2F};
    rgb[static_cast<std::size_t>(axis)] = 1.0F;
    marker.points.push_back(to_message(origin));
    marker.points.push_back(to_message(origin + length * Vector3d::Unit(axis)));
    marker.colors.insert(marker.colors.end(), 2, color(rgb));
  }
}

void MarkerBuilder::build(const std_msgs::Header& header, const Drawing& drawing,
                          const MarkerOptions& options, visualization_msgs::MarkerArray& markers) {
  const auto& [fibers, contacts, minimum, boxes, cost, crossings, names, legend, passed] = drawing;
  const MarkerScale scale(fibers, header.frame_id);
  // Thicker than the fibres, to be seen where two of them hide the point of contact.
  const double thickness = 3.0 * scale.thickest;
  static const Canvas::Names namespaces{"fibers",    "contacts",     "normals", "passed",
                                        "nearest",   "nearest_text", "cost",    "boxes",
                                        "crossings", "names",        "legend",  "axes"};
  Canvas canvas(header, namespaces, markers);
  if (options.show_fibers && fibers.segment_count() > most_tube_segments) {
    draw_lines(fibers, 2.0 * scale.thinnest, canvas);
  } else if (options.show_fibers) {
    draw_tubes(fibers, canvas);
  }
  if (options.show_contacts && !contacts.empty()) {
    draw_contacts(fibers, contacts, thickness, canvas);
    draw_normals(fibers, contacts, thickness, canvas);
  }
  if (options.show_passed && passed != nullptr && !passed->empty()) {
    draw_passed(*passed, 1.5 * thickness, canvas);
  }
  if (options.show_nearest && minimum != nullptr) {
    draw_nearest(*minimum, scale, canvas);
  }
  if (options.show_cost) {
    draw_cost(cost, scale, canvas);
  }
  if (options.show_boxes && !boxes.empty()) {
    draw_boxes(boxes, scale.extent, canvas);
  }
  if (options.show_crossings && crossings != nullptr && !crossings->crossings.empty()) {
    draw_crossings(fibers, *crossings, thickness, canvas.add(CROSSINGS, Marker::LINE_LIST));
  }
  if (options.show_names && names != nullptr && names->size() <= most_names) {
    draw_names(fibers, *names, scale, canvas);
  }
  if (options.show_legend && legend != nullptr && fibers.fiber_count() > 0) {
    draw_legend(*legend, scale, LEGEND, canvas);
    draw_axes(scale, canvas);
  }
  canvas.finish(drawn_);
}

}  // namespace fiber_proximity_ros
