#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <string>
#include <vector>

#include "src/ros/outputs/markers.hpp"

namespace fiber_proximity_ros {

inline fiber::FiberAssembly parallel_fibers(std::uint32_t count, std::uint32_t points = 3) {
  std::vector<Eigen::Vector3d> all;
  std::vector<std::uint32_t> offsets{0};
  for (std::uint32_t fiber = 0; fiber < count; ++fiber) {
    for (std::uint32_t i = 0; i < points; ++i) {
      all.emplace_back(0.1 * i, 0.03 * fiber, 0.0);
    }
    offsets.push_back(static_cast<std::uint32_t>(all.size()));
  }
  return {all, offsets, {0.01}};
}

/// Builder, its inputs and the last output.
class Markers : public testing::Test {
 protected:
  Markers() {
    header_.frame_id = "world";
    header_.stamp = ros::Time(12, 34);
    options_.show_boxes = true;
  }

  void build(const fiber::FiberAssembly& fibers) {
    builder_.build(header_,
                   {fibers, contacts_.contacts, minimum_, boxes_, cost_, nullptr, &names_, &legend_,
                    nullptr, &unknown_},
                   options_, array_);
  }

  void add_contact(double distance) {
    fiber::Contact contact;
    contact.fiber_b = 1;
    contact.distance = distance;
    contact.point_a = {0.1, 0.01, 0.0};
    contact.point_b = {0.1, 0.01 + distance, 0.0};
    contact.normal = Eigen::Vector3d::UnitY();
    contacts_.contacts.push_back(contact);
  }

  const visualization_msgs::Marker* find(const std::string& ns, int id = 0,
                                         int action = visualization_msgs::Marker::ADD) const {
    const auto found =
        std::find_if(array_.markers.begin(), array_.markers.end(),
                     [&](const visualization_msgs::Marker& marker) {
                       return marker.ns == ns && marker.id == id && marker.action == action;
                     });
    return found == array_.markers.end() ? nullptr : &*found;
  }

  std::size_t deletions() const {
    return static_cast<std::size_t>(std::count_if(
        array_.markers.begin(), array_.markers.end(), [](const visualization_msgs::Marker& marker) {
          return marker.action == visualization_msgs::Marker::DELETE;
        }));
  }

  std_msgs::Header header_;
  fiber::QueryResult contacts_;
  const fiber::Contact* minimum_ = nullptr;
  std::vector<fiber::NodeBox> boxes_;
  std::string cost_;
  std::vector<std::string> names_;
  std::vector<LegendLine> legend_;
  std::vector<std::string> unknown_;
  MarkerOptions options_;
  MarkerBuilder builder_;
  visualization_msgs::MarkerArray array_;
};

}  // namespace fiber_proximity_ros
