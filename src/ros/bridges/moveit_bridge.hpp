#pragma once

#include <moveit_msgs/CollisionObject.h>
#include <moveit_msgs/PlanningScene.h>
#include <ros/node_handle.h>

#include <cstddef>
#include <deque>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "fiber_proximity/ApplyObstacles.h"
#include "fiber_proximity/Obstacle.h"

namespace fiber_proximity_ros {

/// The obstacle with the same name, shapes and poses, and the same operation. What it holds is
/// validated where it is applied. The stamp is left out: MoveIt, too, places objects by where their
/// frames are when the message comes. Subframes and the type have no counterpart.
fiber_proximity::Obstacle to_obstacle(const moveit_msgs::CollisionObject& object);

/// The objects of the scene's world, in their order. One that is not a difference from another
/// scene is all there is: the removal of all obstacles comes first.
std::vector<fiber_proximity::Obstacle> to_obstacles(const moveit_msgs::PlanningScene& scene);

/// The octomap of the scene's world, in the frame of the scene's; none if it has no data or its
/// origin is displaced, for which Octomap has no field.
std::optional<octomap_msgs::Octomap> octomap_of(const moveit_msgs::PlanningScene& scene);

/// Lists the parts of an object, or of a scene and its objects, that have no counterpart in the
/// environment.
std::vector<std::string> without_counterpart(const moveit_msgs::CollisionObject& object);
std::vector<std::string> without_counterpart(const moveit_msgs::PlanningScene& scene);

/// MoveIt's objects as obstacles of a proximity_node: subscribes to `collision_object` and
/// `planning_scene` and calls `proximity/apply_obstacles` once for each message, in the order of
/// their arrival. A scene's octomap is published on `octomap`, where octomap_bridge takes it.
class MoveitBridge {
 public:
  /// Messages that wait while the service is not there; one that comes on top is an error in the
  /// log.
  static constexpr std::size_t max_waiting = 1000;

  explicit MoveitBridge(ros::NodeHandle node);
  MoveitBridge(const MoveitBridge&) = delete;
  MoveitBridge& operator=(const MoveitBridge&) = delete;

 private:
  struct Change {
    std::string topic;
    fiber_proximity::ApplyObstacles::Request request;
  };

  void receive_object(const moveit_msgs::CollisionObject& object);
  void receive_scene(const moveit_msgs::PlanningScene& scene);
  void publish_octomap(const moveit_msgs::PlanningScene& scene);

  void apply(const std::string& topic, std::vector<fiber_proximity::Obstacle> obstacles);
  void apply_waiting();

  /// Says so of each of these once.
  void warn_of(const std::string& topic, const std::vector<std::string>& without_counterpart);

  std::string service_;
  ros::ServiceClient client_;
  ros::Publisher octomap_publisher_;
  std::optional<std_msgs::Header> octomap_header_;  // of the map that was published last
  std::deque<Change> waiting_;
  std::set<std::string> warned_of_;

  // Last: their callbacks use all of the above.
  ros::Subscriber object_subscriber_;
  ros::Subscriber scene_subscriber_;
  ros::WallTimer timer_;
};

}  // namespace fiber_proximity_ros
