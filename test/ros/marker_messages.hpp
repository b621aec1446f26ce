#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "src/ros/inputs/marker_input.hpp"
#include "test/ros/messages.hpp"
#include "test/support/error_of.hpp"

/// Messages of markers, and what an input makes of them.
namespace fiber_proximity_ros {
namespace marker_test {

using test_messages::header;
using test_messages::marker;
using test_messages::Points;
using visualization_msgs::Marker;
using visualization_msgs::MarkerArray;

inline Points chain(double x) { return {{x, 0, 0}, {x, 1, 0}, {x, 1, 1}, {x, 0, 1.5}}; }

/// The segments of a chain, as pairs of points.
inline Points segments(const Points& chain) {
  Points pairs;
  for (std::size_t i = 0; i + 1 < chain.size(); ++i) {
    pairs.push_back(chain[i]);
    pairs.push_back(chain[i + 1]);
  }
  return pairs;
}

/// With ids by their places, as they would be in place of each other with the same.
inline MarkerArray array(std::vector<Marker> markers) {
  MarkerArray message;
  message.markers = std::move(markers);
  for (std::size_t i = 0; i < message.markers.size(); ++i) {
    message.markers[i].id = static_cast<std::int32_t>(i);
  }
  return message;
}

inline std::vector<MarkerInput::MarkerPtr> parts_of(const MarkerArray& message) {
  std::vector<MarkerInput::MarkerPtr> parts;
  for (const Marker& marker : message.markers) {
    parts.push_back(std::make_shared<const Marker>(marker));
  }
  return parts;
}

/// As the first message of an input.
inline ReadResult read_first(const MarkerArray& message, const MarkerInputOptions& options,
                             FiberBuffer& buffer) {
  return MarkerInput(options).read(parts_of(message), ros::Time(100.0), buffer);
}

inline FiberBuffer read(const MarkerArray& message, const MarkerInputOptions& options = {}) {
  FiberBuffer buffer;
  EXPECT_TRUE(read_first(message, options, buffer).is_for_input);
  return buffer;
}

inline std::string refusal_of(const MarkerArray& message) {
  FiberBuffer buffer;
  return fiber::test::error_of([&] { read_first(message, {}, buffer); });
}

inline Marker strip_of(const std::string& ns, const Points& points) {
  Marker strip = marker(header("map"), Marker::LINE_STRIP, points);
  strip.ns = ns;
  return strip;
}

}  // namespace marker_test
}  // namespace fiber_proximity_ros
