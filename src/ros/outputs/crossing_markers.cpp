#include "src/ros/outputs/crossing_markers.hpp"

#include <cstdint>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/outputs/marker_canvas.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;

// From the crossing, in thicknesses.
constexpr double bar_end = 2.5;
constexpr double gap_end = 1.0;

std_msgs::ColorRGBA color_of(int sign) {
  return color(sign > 0 ? palette::positive_crossing : palette::negative_crossing);
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

fiber::Capsule segment_of(const fiber::FiberAssembly& fibers, std::uint32_t fiber,
                          std::uint32_t segment) {
  return fibers.capsule(fibers.offsets()[fiber] + segment);
}

}  // namespace

void draw_crossings(const fiber::FiberAssembly& fibers, const CrossingDrawing& drawing,
                    double thickness, visualization_msgs::Marker& marker) {
  marker.scale.x = thickness;
  const auto add_line = [&](const Strand& strand, double from, double to) {
    marker.points.push_back(to_message(strand.at + from * thickness * strand.along));
    marker.points.push_back(to_message(strand.at + to * thickness * strand.along));
  };
  for (const fiber::Crossing& crossing : drawing.crossings) {
    const Strand a(segment_of(fibers, crossing.fiber_a, crossing.segment_a), crossing.point_a,
                   drawing.view);
    const Strand b(segment_of(fibers, crossing.fiber_b, crossing.segment_b), crossing.point_b,
                   drawing.view);
    const Strand& over = crossing.a_is_over ? a : b;
    const Strand& under = crossing.a_is_over ? b : a;
    add_line(over, -bar_end, bar_end);
    add_line(under, -bar_end, -gap_end);
    add_line(under, gap_end, bar_end);
    marker.colors.insert(marker.colors.end(), 6, color_of(crossing.sign));
  }
}

}  // namespace fiber_proximity_ros
