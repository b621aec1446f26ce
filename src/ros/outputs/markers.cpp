#include "src/ros/outputs/markers.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <map>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/label_place.hpp"
#include "src/ros/outputs/tube_mesh.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr double text_height = 0.035;  // of the scene

std_msgs::ColorRGBA color_of(std::uint32_t fiber) { return color(fiber_color(fiber)); }

std_msgs::ColorRGBA contact_color(const fiber::Contact& contact, double certain_margin) {
  const Rgb& kind = contact.distance < 0.0 ? palette::penetrating : palette::within_margin;
  return color(contact.upper > certain_margin ? mix(kind, palette::possible, 0.6) : kind);
}

Vector3d middle_of(const fiber::Contact& contact) {
  return 0.5 * contact.point_a + 0.5 * contact.point_b;
}

fiber::Capsule segment_of(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                          std::uint32_t segment) {
  return fibers.capsule(fibers.offsets()[fiber] + segment);
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

/// Diameter [m] of the disc that shows a contact: where fibres touch, or nearly do, the largest
/// one, to look out between them; elsewhere less than the thinner one is thick, to cover neither.
/// @param largest [m] thicker than any fibre
double disc_size(const fiber::FiberAssembly& fibers, const fiber::Contact& contact,
                 double largest) {
  const double thinner = std::max(
      hairline_radius, std::min(segment_of(fibers, contact.fiber_a, contact.segment_a).radius,
                                segment_of(fibers, contact.fiber_b, contact.segment_b).radius));
  return contact.distance <= thinner ? largest : 1.5 * thinner;
}

void draw_tubes(const fiber::FiberAssembly& fibers, MarkerCanvas& canvas) {
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    Marker& marker = canvas.add("fibers", Marker::TRIANGLE_LIST);
    marker.scale.x = marker.scale.y = marker.scale.z = 1.0;
    marker.color = color_of(fiber);
    append_tube(fibers, fiber, marker.points);
  }
}

void draw_lines(const fiber::FiberAssembly& fibers, double width, MarkerCanvas& canvas) {
  Marker& marker = canvas.add("fibers", Marker::LINE_LIST);
  marker.scale.x = width;
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    for (std::size_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      append_line(fibers.points()[i], fibers.points()[i + 1], color_of(fiber), marker);
    }
  }
}

/// A SPHERE_LIST has one size for all: sizes are rounded down, by a sixth at most.
void draw_contacts(const fiber::FiberAssembly& fibers, const std::vector<fiber::Contact>& contacts,
                   double largest, double certain_margin, MarkerCanvas& canvas) {
  constexpr double steps_per_halving = 4.0;
  std::map<int, std::vector<const fiber::Contact*>> by_size;
  for (const fiber::Contact& contact : contacts) {
    const double halvings = std::log2(largest / disc_size(fibers, contact, largest));
    by_size[static_cast<int>(std::ceil(steps_per_halving * halvings - 1e-9))].push_back(&contact);
  }
  for (const auto& [steps, alike] : by_size) {
    Marker& marker = canvas.add("contacts", Marker::SPHERE_LIST);
    marker.scale.x = marker.scale.y = marker.scale.z =
        largest * std::exp2(-steps / steps_per_halving);
    for (const fiber::Contact* contact : alike) {
      marker.points.push_back(to_message(middle_of(*contact)));
      marker.colors.push_back(contact_color(*contact, certain_margin));
    }
  }
}

void draw_normals(const fiber::FiberAssembly& fibers, const std::vector<fiber::Contact>& contacts,
                  double largest, double certain_margin, MarkerCanvas& canvas) {
  Marker& marker = canvas.add("normals", Marker::LINE_LIST);
  marker.scale.x = 0.08 * largest;
  for (const fiber::Contact& contact : contacts) {
    const Vector3d start = middle_of(contact);
    const double length = 1.2 * disc_size(fibers, contact, largest);
    append_line(start, start + length * contact.normal, contact_color(contact, certain_margin),
                marker);
  }
}

void draw_passed(const std::vector<fiber::Contact>& contacts, double largest,
                 MarkerCanvas& canvas) {
  Marker& marker = canvas.add("passed", Marker::SPHERE_LIST);
  marker.scale.x = marker.scale.y = marker.scale.z = largest;
  marker.color = color(palette::passed);
  for (const fiber::Contact& contact : contacts) {
    marker.points.push_back(to_message(middle_of(contact)));
  }
}

void draw_nearest(const fiber::FiberAssembly& fibers, const fiber::Contact& minimum,
                  const MarkerScale& scale, MarkerCanvas& canvas) {
  const std::string text = distance_text(minimum.distance);
  const double height = text_height * scale.extent;
  const double gap = 1.5 * height;
  const Label label{middle_of(minimum), scale.up, gap, height, text.size(), Vector3d::Zero(), {}};
  draw_closest_pair(fibers, scale, minimum, color(palette::nearest), label, text, "nearest",
                    canvas);
}

void draw_boxes(const std::vector<fiber::NodeBox>& boxes, double extent, MarkerCanvas& canvas) {
  Marker& marker = canvas.add("boxes", Marker::LINE_LIST);
  marker.scale.x = 0.001 * extent;
  marker.color = color(palette::boxes, 0.35F);
  for (const fiber::NodeBox& box : boxes) {
    append_box(box, marker.points);
  }
}

void draw_names(const fiber::FiberAssembly& fibers, const std::vector<std::string>& names,
                const MarkerScale& scale, MarkerCanvas& canvas) {
  assert(names.size() == fibers.fiber_count());
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t first = fibers.offsets()[fiber];
    const Vector3d& end = fibers.points()[first];
    const Vector3d& middle = fibers.points()[(first + fibers.offsets()[fiber + 1]) / 2];
    const Vector3d outward = (end - middle).stableNormalized();
    // Beside its end, a little above: as far away as it is wide there.
    const double height = text_height * scale.extent;
    const double width = text_width(height, names[fiber].size());
    const double reach = 0.5 * (height + width * std::abs(scale.side().dot(outward)));
    const Vector3d position =
        end + (scale.thickest + reach) * outward + (scale.thickest + 0.5 * height) * scale.up;
    canvas.add_text("names", height, position, names[fiber]).color =
        color(mix({1.0F, 1.0F, 1.0F}, fiber_color(fiber), 0.5));
  }
}

/// x red, y green, z blue, as everywhere in rviz; beside the legend, and not in the corner where
/// the display of the legend has it.
void draw_axes(const MarkerScale& scale, MarkerCanvas& canvas) {
  const double length = 0.12 * scale.extent;
  Marker& marker = canvas.add("axes", Marker::LINE_LIST);
  marker.scale.x = 0.06 * length;
  const Vector3d origin = scale.bottom() - 0.12 * scale.extent * scale.up +
                          0.35 * scale.box.sizes().x() * Vector3d::UnitX();
  for (int axis = 0; axis < 3; ++axis) {
    Rgb rgb{0.2F, 0.2F, 0.2F};
    rgb[static_cast<std::size_t>(axis)] = 1.0F;
    append_line(origin, origin + length * Vector3d::Unit(axis), color(rgb), marker);
  }
}

/// The things that an answer lacks, in one line.
std::string incomplete_text(const std::vector<std::string>& unknown) {
  assert(!unknown.empty());
  std::string text = "incomplete: " + unknown.front();
  if (unknown.size() > 1) {
    text += "; and " + std::to_string(unknown.size() - 1) + " more";
  }
  return text;
}

/// Above all else. Without fibres there is nothing that it could lie beside, or be as large as.
void draw_incomplete(const std::vector<std::string>& unknown, const MarkerScale& scale,
                     MarkerCanvas& canvas) {
  const double extent = scale.extent > 0.0 ? scale.extent : 1.0;
  canvas
      .add_text("incomplete", text_height * extent, scale.top + 0.22 * extent * scale.up,
                incomplete_text(unknown))
      .color = color(palette::incomplete);
}

/// The last line, of the times of an answer's parts, breaks behind commas where it gets longer than
/// the others.
std::string wrapped(std::string text) {
  constexpr std::size_t columns = 50;
  std::size_t begin = text.rfind('\n') + 1;  // 0 if there is none
  for (std::size_t i = begin; i + 1 < text.size(); ++i) {
    if (text[i] == ',' && i - begin >= columns) {
      begin = ++i;
      text[i] = '\n';
    }
  }
  return text;
}

/// One of the two strands of a crossing.
struct Strand {
  Vector3d at;     // [m] the crossing, moved out of the fibre towards the viewer
  Vector3d along;  // unit vector

  Strand(const fiber::Capsule& segment, const Vector3d& point, const fiber::View& view)
      : along((segment.p1 - segment.p0).stableNormalized()) {
    const Vector3d ray = view.is_perspective ? Vector3d(point - view.eye) : view.direction;
    at = point - 1.1 * segment.radius * ray.stableNormalized();
  }
};

}  // namespace

std::vector<LegendLine> legend_lines(const MarkerOptions& options, bool has_distances,
                                     double margin) {
  std::vector<LegendLine> lines;
  if (options.show_contacts) {
    lines.push_back({palette::penetrating, "red: penetrating"});
    if (margin > 0.0) {
      lines.push_back({palette::within_margin, std::isfinite(margin)
                                                   ? "amber: within " + distance_text(margin)
                                                   : "amber: apart"});
    }
    if (std::isfinite(options.certain_margin)) {
      lines.push_back({palette::possible, "pale: possible, not certain"});
    }
    lines.push_back({palette::normal, "lines: normals of contacts"});
  }
  if (options.show_passed) {
    lines.push_back({palette::passed, "cyan: came and went between two messages"});
  }
  if (has_distances) {
    lines.push_back({palette::distant,
                     "red to green: from objects, 0 to " + distance_text(options.free_distance)});
  }
  if (options.show_crossings) {
    lines.push_back({palette::positive_crossing, "green: crossing of sign +1"});
    lines.push_back({palette::negative_crossing, "magenta: crossing of sign -1"});
  }
  if (options.show_boxes) {
    lines.push_back({palette::boxes, "boxes: level " + std::to_string(options.level)});
  }
  if (options.show_nearest) {
    lines.push_back({palette::nearest, "white: nearest pair"});
  }
  return lines;
}

void draw_crossings(const fiber::FiberAssembly& fibers, const CrossingDrawing& drawing,
                    double thickness, visualization_msgs::Marker& marker) {
  // From the crossing, in thicknesses.
  constexpr double bar_end = 2.5;
  constexpr double gap_end = 1.0;
  marker.scale.x = thickness;
  for (const fiber::Crossing& crossing : drawing.crossings) {
    const Strand a(segment_of(fibers, crossing.fiber_a, crossing.segment_a), crossing.point_a,
                   drawing.view);
    const Strand b(segment_of(fibers, crossing.fiber_b, crossing.segment_b), crossing.point_b,
                   drawing.view);
    const auto add_line = [&](const Strand& strand, double from, double to) {
      append_line(
          strand.at + from * thickness * strand.along, strand.at + to * thickness * strand.along,
          color(crossing.sign > 0 ? palette::positive_crossing : palette::negative_crossing),
          marker);
    };
    const Strand& under = crossing.a_is_over ? b : a;
    add_line(crossing.a_is_over ? a : b, -bar_end, bar_end);
    add_line(under, -bar_end, -gap_end);
    add_line(under, gap_end, bar_end);
  }
}

void MarkerBuilder::build(const std_msgs::Header& header, const Drawing& drawing,
                          const MarkerOptions& options, visualization_msgs::MarkerArray& markers) {
  const auto& [fibers, contacts, minimum, boxes, cost, crossings, names, legend, passed, unknown,
               environment] = drawing;
  const MarkerScale scale(fibers, header.frame_id);
  // Thicker than the fibres, to be seen where two of them hide the point of contact.
  const double thickness = 3.0 * scale.thickest;
  MarkerCanvas canvas(header, markers);
  if (options.show_fibers && fibers.segment_count() > max_tube_segments) {
    draw_lines(fibers, 2.0 * scale.thinnest, canvas);
  } else if (options.show_fibers) {
    draw_tubes(fibers, canvas);
  }
  if (options.show_contacts && !contacts.empty()) {
    draw_contacts(fibers, contacts, thickness, options.certain_margin, canvas);
    draw_normals(fibers, contacts, thickness, options.certain_margin, canvas);
  }
  if (options.show_passed && passed != nullptr && !passed->empty()) {
    draw_passed(*passed, 1.5 * thickness, canvas);
  }
  if (options.show_nearest && minimum != nullptr) {
    draw_nearest(fibers, *minimum, scale, canvas);
  }
  if (options.show_cost) {
    constexpr double smaller = 0.7;
    canvas.add_text("cost", smaller * text_height * scale.extent,
                    scale.top + 0.15 * scale.extent * scale.up, wrapped(cost));
  }
  if (options.show_boxes && !boxes.empty()) {
    draw_boxes(boxes, scale.extent, canvas);
  }
  if (options.show_crossings && crossings != nullptr && !crossings->crossings.empty()) {
    draw_crossings(fibers, *crossings, thickness, canvas.add("crossings", Marker::LINE_LIST));
  }
  if (options.show_names && names != nullptr && names->size() <= max_names) {
    draw_names(fibers, *names, scale, canvas);
  }
  if (options.show_legend && legend != nullptr && fibers.fiber_count() > 0) {
    canvas.add_legend(*legend, scale);
    draw_axes(scale, canvas);
  }
  if (unknown != nullptr && !unknown->empty()) {
    draw_incomplete(*unknown, scale, canvas);
  }
  if (environment != nullptr && options.show_objects && fibers.fiber_count() > 0) {
    draw_objects(fibers, environment->objects, options.reach, canvas);
  }
  if (environment != nullptr && options.show_contacts && !environment->contacts.empty()) {
    draw_distances(environment->contacts, options.free_distance, thickness, canvas);
  }
  if (environment != nullptr && options.show_nearest && environment->minimum != nullptr) {
    draw_nearest_object(fibers, *environment, options.free_distance, scale, canvas);
  }
  canvas.finish(drawn_);
}

}  // namespace fiber_proximity_ros
