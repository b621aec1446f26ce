#include "fiber_proximity/ros/markers.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>
#include <string>

#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/tube_mesh.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

std_msgs::ColorRGBA color(float r, float g, float b, float a = 1.0F) {
  std_msgs::ColorRGBA result;
  result.r = r;
  result.g = g;
  result.b = b;
  result.a = a;
  return result;
}

/// Cool and pale colours for the fibres: red and amber belong to the contacts.
std_msgs::ColorRGBA fiber_color(std::uint32_t fiber) {
  static const std::array<std_msgs::ColorRGBA, 8> palette{
      color(0.16F, 0.50F, 0.86F), color(0.10F, 0.68F, 0.60F), color(0.56F, 0.43F, 0.86F),
      color(0.78F, 0.82F, 0.86F), color(0.42F, 0.70F, 0.30F), color(0.32F, 0.74F, 0.90F),
      color(0.82F, 0.50F, 0.74F), color(0.34F, 0.42F, 0.58F)};
  return palette[fiber % palette.size()];
}

std_msgs::ColorRGBA contact_color(const fiber::Contact& contact) {
  return contact.distance < 0.0 ? color(0.95F, 0.15F, 0.12F) : color(1.0F, 0.70F, 0.10F);
}

Vector3d middle_of(const fiber::Contact& contact) {
  return 0.5 * contact.point_a + 0.5 * contact.point_b;
}

/// Lengths that annotations are measured in [m].
struct Scale {
  double thickest = 0.0;                                      ///< largest radius
  double thinnest = std::numeric_limits<double>::infinity();  ///< smallest radius
  double extent = 0.0;                                        ///< longest side of the bounding box

  explicit Scale(const fiber::FiberAssembly& fibers) {
    for (const double radius : fibers.radii()) {
      thickest = std::max(thickest, radius);
      thinnest = std::min(thinnest, radius);
    }
    thickest = std::max(thickest, hairline_radius);
    thinnest = std::max(thinnest, hairline_radius);
    if (fibers.points().empty()) {
      return;
    }
    Vector3d lower = fibers.points().front();
    Vector3d upper = lower;
    for (const Vector3d& point : fibers.points()) {
      lower = lower.cwiseMin(point);
      upper = upper.cwiseMax(point);
    }
    extent = std::max((upper - lower).maxCoeff(), thickest);
  }
};

std::string distance_text(double distance) {
  std::array<char, 48> text{};
  std::snprintf(text.data(), text.size(), "%.1f mm", 1e3 * distance);
  return text.data();
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

/// Hands out the markers of one update and keeps count of them.
class MarkerBuilder::Canvas {
 public:
  Canvas(const std_msgs::Header& header, visualization_msgs::MarkerArray& markers)
      : header_(header), markers_(markers.markers) {}

  /// The next marker of this namespace, without points.
  Marker& add(Namespace ns, int type) {
    Marker& marker = take(ns, counts_[ns]++, Marker::ADD);
    marker.type = type;
    return marker;
  }

  /// Deletes what was drawn and has not been drawn again; remembers what has.
  void finish(std::array<std::int32_t, COUNT>& drawn) {
    for (std::uint8_t ns = 0; ns < COUNT; ++ns) {
      for (std::int32_t id = counts_[ns]; id < drawn[ns]; ++id) {
        take(static_cast<Namespace>(ns), id, Marker::DELETE);
      }
    }
    drawn = counts_;
    markers_.resize(used_);
  }

 private:
  Marker& take(Namespace ns, std::int32_t id, int action) {
    static const std::array<const char*, COUNT> names{"fibers",  "contacts",     "normals",
                                                      "nearest", "nearest_text", "boxes"};
    if (used_ == markers_.size()) {
      markers_.emplace_back();
    }
    Marker& marker = markers_[used_++];
    marker.header = header_;
    marker.ns = names[ns];
    marker.id = id;
    marker.action = action;
    marker.type = 0;
    marker.pose = geometry_msgs::Pose();
    marker.pose.orientation.w = 1.0;
    marker.scale = geometry_msgs::Vector3();
    marker.color = color(1.0F, 1.0F, 1.0F);
    marker.points.clear();
    marker.colors.clear();
    marker.text.clear();
    return marker;
  }

  const std_msgs::Header& header_;
  std::vector<Marker>& markers_;
  std::size_t used_ = 0;
  std::array<std::int32_t, COUNT> counts_{};
};

void MarkerBuilder::draw_tubes(const fiber::FiberAssembly& fibers, Canvas& canvas) {
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    Marker& marker = canvas.add(FIBERS, Marker::TRIANGLE_LIST);
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
    marker.color = fiber_color(fiber);
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
      marker.colors.insert(marker.colors.end(), 2, fiber_color(fiber));
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

void MarkerBuilder::build(const std_msgs::Header& header, const fiber::FiberAssembly& fibers,
                          const fiber::QueryResult& contacts, const fiber::Contact* minimum,
                          const std::vector<fiber::NodeBox>& boxes, const MarkerOptions& options,
                          visualization_msgs::MarkerArray& markers) {
  const Scale scale(fibers);
  // Thicker than the fibres, to be seen where two of them hide the point of contact.
  const double thickness = 3.0 * scale.thickest;
  Canvas canvas(header, markers);
  if (options.show_fibers && fibers.segment_count() > most_tube_segments) {
    draw_lines(fibers, 2.0 * scale.thinnest, canvas);
  } else if (options.show_fibers) {
    draw_tubes(fibers, canvas);
  }
  if (options.show_contacts && !contacts.contacts.empty()) {
    draw_contacts(contacts.contacts, thickness, canvas);
    draw_normals(contacts.contacts, thickness, canvas);
  }
  if (options.show_nearest && minimum != nullptr) {
    draw_nearest(*minimum, scale.extent, canvas);
  }
  if (options.show_boxes && !boxes.empty()) {
    draw_boxes(boxes, scale.extent, canvas);
  }
  canvas.finish(drawn_);
}

}  // namespace fiber_proximity_ros
