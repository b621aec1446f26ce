#pragma once

#include <std_msgs/ColorRGBA.h>
#include <std_msgs/Header.h>
#include <visualization_msgs/MarkerArray.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "src/ros/outputs/palette.hpp"

namespace fiber_proximity_ros {

inline std_msgs::ColorRGBA color(float r, float g, float b, float a = 1.0F) {
  std_msgs::ColorRGBA result;
  result.r = r;
  result.g = g;
  result.b = b;
  result.a = a;
  return result;
}

inline std_msgs::ColorRGBA color(const Rgb& rgb, float a = 1.0F) {
  return color(rgb[0], rgb[1], rgb[2], a);
}

/// Hands out the markers of one update and keeps count of them: those of each of `count` namespaces
/// have the ids 0, 1, …
template <std::size_t count>
class MarkerCanvas {
 public:
  using Names = std::array<const char*, count>;
  using Counts = std::array<std::int32_t, count>;

  /// Holds references: they must outlive it.
  /// @param markers those from `first` on are overwritten, and their memory is reused
  MarkerCanvas(const std_msgs::Header& header, const Names& names,
               visualization_msgs::MarkerArray& markers, std::size_t first = 0)
      : header_(header), names_(names), markers_(markers.markers), used_(first) {}

  /// The next marker of this namespace, an index of the names, without points.
  visualization_msgs::Marker& add(std::size_t ns, int type) {
    visualization_msgs::Marker& marker = take(ns, counts_[ns]++, visualization_msgs::Marker::ADD);
    marker.type = type;
    return marker;
  }

  /// Deletes what was drawn and has not been drawn again; remembers what has.
  void finish(Counts& drawn) {
    for (std::size_t ns = 0; ns < count; ++ns) {
      for (std::int32_t id = counts_[ns]; id < drawn[ns]; ++id) {
        take(ns, id, visualization_msgs::Marker::DELETE);
      }
    }
    drawn = counts_;
    markers_.resize(used_);
  }

 private:
  visualization_msgs::Marker& take(std::size_t ns, std::int32_t id, int action) {
    if (used_ == markers_.size()) {
      markers_.emplace_back();
    }
    visualization_msgs::Marker& marker = markers_[used_++];
    marker.header = header_;
    marker.ns = names_[ns];
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
  const Names& names_;
  std::vector<visualization_msgs::Marker>& markers_;
  std::size_t used_;
  Counts counts_{};
};

}  // namespace fiber_proximity_ros
