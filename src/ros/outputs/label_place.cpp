#include "src/ros/outputs/label_place.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector2d;
using Eigen::Vector3d;

/// The image that is seen from the front, and from as far above as the views of this package look.
struct Picture {
  explicit Picture(const MarkerScale& scale)
      : side(scale.side()),
        up(std::cos(looking_down) * scale.up - std::sin(looking_down) * scale.front()) {}

  static constexpr double looking_down = 0.6;  // [rad]

  Vector2d operator()(const Vector3d& point) const { return {side.dot(point), up.dot(point)}; }

  Vector3d side;
  Vector3d up;
};

/// Squared distance of a segment from a box about the origin; exact enough for a text.
double squared_distance(const Vector2d& a, const Vector2d& b, const Vector2d& half) {
  const Vector2d along = b - a;
  const auto from_box = [&half](const Vector2d& p) {
    return (p.cwiseAbs() - half).cwiseMax(0.0).squaredNorm();
  };
  // The function along the segment is convex: thirds of it until they are much less than the box.
  double low = 0.0;
  double high = 1.0;
  for (int i = 0; i < 12; ++i) {
    const double one = low + (high - low) / 3.0;
    const double other = high - (high - low) / 3.0;
    if (from_box(a + one * along) <= from_box(a + other * along)) {
      high = other;
    } else {
      low = one;
    }
  }
  return from_box(a + low * along);
}

/// [m] Between a text and the nearest fibre, as the picture has them; no more than is asked for.
double room_around(const fiber::FiberAssembly& fibers, const Picture& picture,
                   const Vector3d& place, const Vector2d& half, double enough) {
  const Vector2d middle = picture(place);
  double room = enough;
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count() && room > 0.0; ++fiber) {
    for (std::uint32_t i = fibers.offsets()[fiber]; i + 1 < fibers.offsets()[fiber + 1]; ++i) {
      const double radius = fibers.segment_radius(i);
      const Vector2d a = picture(fibers.points()[i]) - middle;
      const Vector2d b = picture(fibers.points()[i + 1]) - middle;
      const Vector2d reach = half + Vector2d::Constant(room + radius);
      if ((a.cwiseMin(b).array() > reach.array()).any() ||
          (a.cwiseMax(b).array() < -reach.array()).any()) {
        continue;
      }
      room = std::min(room, std::sqrt(squared_distance(a, b, half)) - radius);
    }
  }
  return room;
}

bool lies_across(const std::vector<PlacedText>& others, const Picture& picture,
                 const Vector3d& place, const Vector2d& half) {
  return std::any_of(others.begin(), others.end(), [&](const PlacedText& other) {
    const Vector2d reach =
        half + 0.5 * Vector2d(text_width(other.height, other.letters), other.height);
    const Vector2d apart = picture(place - other.middle).cwiseAbs();
    return (apart.array() < reach.array()).all();
  });
}

/// [m] From the middle of a text to its edge.
double half_extent(const MarkerScale& scale, const Label& label, const Vector3d& direction) {
  return 0.5 * (std::abs(direction.dot(scale.side())) * text_width(label.height, label.letters) +
                std::abs(direction.dot(scale.up)) * label.height);
}

}  // namespace

double text_width(double height, std::size_t letters) {
  return 0.5 * height * static_cast<double>(letters);
}

Vector3d label_place(const fiber::FiberAssembly& fibers, const MarkerScale& scale,
                     const Label& label) {
  const Picture picture(scale);
  const Vector2d half(0.5 * text_width(label.height, label.letters), 0.5 * label.height);
  // As far away as its own size in that direction, and the gap.
  const auto place_at = [&](const Vector3d& direction, double gaps) {
    const double own = half_extent(scale, label, direction);
    return Vector3d(label.point + (gaps * label.gap + own) * direction);
  };
  const Vector3d& first = label.preferred;
  if (fibers.segment_count() > max_label_segments) {
    return place_at(first, 1.0);
  }
  const Vector3d& up = scale.up;
  const Vector3d side = scale.side();
  const double slant = std::sqrt(0.5);
  // Above, above what is right above, sideways and below.
  const std::array<std::pair<Vector3d, double>, 13> places{{{first, 1.0},
                                                            {up, 1.0},
                                                            {slant * (up + side), 1.0},
                                                            {slant * (up - side), 1.0},
                                                            {first, 3.0},
                                                            {up, 3.0},
                                                            {side, 1.0},
                                                            {-side, 1.0},
                                                            {slant * (side - up), 1.0},
                                                            {slant * (-side - up), 1.0},
                                                            {slant * (up + side), 3.0},
                                                            {slant * (up - side), 3.0},
                                                            {-up, 1.0}}};
  const double enough = 0.5 * label.height;
  Vector3d best = place_at(first, 1.0);
  double max_room = -std::numeric_limits<double>::infinity();
  for (const auto& [direction, gaps] : places) {
    if (direction.dot(label.inwards) > 0.1) {
      continue;
    }
    const Vector3d place = place_at(direction, gaps);
    const double room = lies_across(label.others, picture, place, half)
                            ? -label.gap
                            : room_around(fibers, picture, place, half, enough);
    if (room >= enough) {
      return place;
    }
    if (room > max_room) {
      max_room = room;
      best = place;
    }
  }
  return best;
}

Vector3d leader_end(const MarkerScale& scale, const Label& label, const Vector3d& place) {
  const Vector3d direction = (place - label.point).stableNormalized();
  const double distance = (place - label.point).norm() - half_extent(scale, label, direction);
  return label.point + 0.9 * distance * direction;
}

void draw_closest_pair(const fiber::FiberAssembly& fibers, const MarkerScale& scale,
                       const fiber::Contact& pair, const std_msgs::ColorRGBA& color,
                       const Label& label, const std::string& text, const std::string& ns,
                       MarkerCanvas& canvas) {
  visualization_msgs::Marker& line = canvas.add(ns, visualization_msgs::Marker::LINE_LIST);
  line.scale.x = 0.004 * scale.extent;
  line.color = color;
  line.points = {to_message(pair.point_a), to_message(pair.point_b)};
  const Vector3d place = label_place(fibers, scale, label);
  canvas.add_text(ns + "_text", label.height, place, text);
  canvas.add_leader(ns + "_leader", scale, label.point, leader_end(scale, label, place));
}

}  // namespace fiber_proximity_ros
