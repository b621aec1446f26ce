#pragma once

#include <visualization_msgs/Marker.h>

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "src/ros/environment/mesh_loader.hpp"
#include "src/ros/environment/obstacle_set.hpp"

namespace fiber_proximity_ros {

/// Markers of one topic as obstacles with the names NAMESPACE/ID: those of the types CUBE, SPHERE,
/// CYLINDER, CUBE_LIST, SPHERE_LIST, TRIANGLE_LIST and MESH_RESOURCE; others are no bodies. As in
/// rviz, a marker is in place of the one of its name before, DELETE of one that is not there does
/// nothing, and a lifetime ends. Names of other topics' obstacles are refused, and so are markers
/// that follow a frame other than the fixed one.
class MarkerObstacles {
 public:
  using Markers = std::vector<visualization_msgs::Marker>;

  /// @param frame must outlive this, as the obstacles
  MarkerObstacles(std::string topic, const MeshLoader& meshes, ObstacleSet& obstacles,
                  const FixedFrame& frame)
      : topic_(std::move(topic)), meshes_(meshes), obstacles_(obstacles), frame_(frame) {}

  /// Makes a change of a message; meshes that are large, or have to be read first, are left to the
  /// worker, which must end before this does. An error names the marker, what is wrong with it and
  /// what is allowed.
  /// @param patience see Change
  Change change_of(std::shared_ptr<const Markers> markers, const ros::Time& now, double patience,
                   Worker& worker);

  /// Removes the obstacles whose lifetimes have ended.
  /// @returns true if there are any
  bool expire(const ros::Time& now);

  /// Has lifetimes end when they would have, as time has gone back by so much.
  void set_back(const ros::Duration& by);

 private:
  /// The change that one marker asks for.
  struct Step {
    std::int32_t action = visualization_msgs::Marker::ADD;
    std::size_t marker = 0;      // its index
    fiber::ObjectChange change;  // in its frame; of DELETE only the name
    ros::Time expiry;            // zero: never
  };
  static constexpr std::size_t max_read_meshes = 64;
  using MeshKey = std::pair<std::string, std::array<double, 3>>;  // resource and scale
  using Names = std::map<std::string, ros::Time>;  // and when their lifetimes end; zero: never

  std::vector<Step> read(const Markers& markers, const ros::Time& now);
  std::optional<Step> read(const visualization_msgs::Marker& marker, const ros::Time& now);
  bool follows_frame(const visualization_msgs::Marker& marker) const;
  bool is_large(const Markers& markers) const;
  std::optional<fiber::Shape> find_mesh(const visualization_msgs::Marker& marker) const;
  std::vector<fiber::PlacedShape> shapes_of(const visualization_msgs::Marker& marker);
  fiber::Shape mesh_of(const visualization_msgs::Marker& marker);
  void apply(const std::vector<Step>& steps, const Change::Poses& poses);
  Names present() const;

  std::string topic_;
  MeshLoader meshes_;
  ObstacleSet& obstacles_;
  const FixedFrame& frame_;
  Names names_;

  // The worker reads markers, too.
  mutable std::mutex mutex_;
  std::map<MeshKey, fiber::Shape> read_meshes_;  // markers repeat them at camera rate, or grow
  std::set<std::int32_t> ignored_types_;
};

}  // namespace fiber_proximity_ros
