#pragma once

#include <ros/node_handle.h>
#include <visualization_msgs/Marker.h>
#include <visualization_msgs/MarkerArray.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/InputStatistics.h"
#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/environment/world.hpp"
#include "src/ros/environment/allowed_pairs_service.hpp"
#include "src/ros/environment/cloud_input.hpp"
#include "src/ros/environment/environment_options.hpp"
#include "src/ros/environment/marker_obstacles.hpp"
#include "src/ros/environment/object_tracks.hpp"
#include "src/ros/environment/obstacle_service.hpp"
#include "src/ros/environment/obstacle_set.hpp"
#include "src/ros/environment/owed_changes.hpp"
#include "src/ros/environment/robot_links.hpp"
#include "src/ros/environment/waiting_changes.hpp"
#include "src/ros/support/unknown.hpp"
#include "src/ros/support/worker.hpp"

namespace fiber_proximity_ros {

/// All that is around the fibres: the scene, the robot, obstacles, markers and the point cloud, in
/// one world. Subscribes to ~obstacles, and to ~cloud and topics of markers if they are configured;
/// serves ~apply_obstacles and ~allow_pairs. Changes of obstacles are made in the order in which
/// they came, through topic or service; those of a topic of markers in theirs. Large meshes are
/// built in a thread of their own. All its callbacks must come from one thread at a time.
class EnvironmentInputs {
 public:
  /// @param frame      must outlive this
  /// @param on_message called for each message that arrives; it should see to it that update() is
  ///        called soon
  /// @throws std::invalid_argument for a scene that the world refuses
  EnvironmentInputs(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                    const EnvironmentOptions& options, FixedFrame& frame,
                    std::function<void()> on_message);
  ~EnvironmentInputs();
  EnvironmentInputs(const EnvironmentInputs&) = delete;
  EnvironmentInputs& operator=(const EnvironmentInputs&) = delete;

  /// Takes over what has arrived, and brings the robot to where it is at this time, that of the
  /// fibres.
  /// @returns true if that, or a service since, changed the world or what is allowed
  bool update(const ros::Time& stamp);

  /// True if update() should be called again soon: something waits for its transform or its mesh,
  /// or the cloud is being worked on.
  bool is_waiting() const;

  /// True if there is something to look at, or may be later: otherwise the fibres are alone.
  bool is_used() const {
    return is_configured_ || world_.object_count() > 0 || changes_.is_waiting() ||
           !owed_.is_empty();
  }

  /// May be kept and asked by any thread.
  std::shared_ptr<const fiber::Environment> environment() const { return world_.environment(); }

  /// Where the objects have been.
  const ObjectTracks& tracks() const { return tracks_; }

  /// @param frames see ObjectTracks
  void keep_tracks(std::size_t frames) { tracks_.keep(frames); }

  /// [s] A pose that is older than this tells nothing of how an object moves now: ~robot_timeout.
  double pose_timeout() const { return pose_timeout_; }

  fiber::AllowedPairs allowed(const std::vector<std::string>& fiber_names) const {
    return fiber::resolve(allowed_->pairs(), fiber_names);
  }

  /// Lists the parts of the environment that are not known now: links and obstacles without
  /// transforms, topics without a message, obstacles that were refused. Objects that every fibre
  /// may touch are left out where contacts are asked about.
  /// @param of_contacts whether allowed pairs count: shapes of a query may touch nothing
  std::vector<Unknown> unknown(bool of_contacts) const;

  /// Where it comes from, as Unknown::source has it.
  std::vector<std::string> sources() const;

  /// State of each topic there is.
  std::vector<fiber_proximity::InputStatistics> statistics(const ros::Time& now) const;

  /// The thread that builds the meshes, one after the other.
  Worker& mesh_builder() { return mesh_builder_; }

 private:
  struct MarkerSource;  // a topic of markers

  bool watch_time(const ros::Time& now);
  void subscribe_to_markers(ros::NodeHandle node, const EnvironmentOptions& options);
  void receive_obstacles(const fiber_proximity::ObstacleArray::ConstPtr& message);
  void receive_markers(std::shared_ptr<const MarkerObstacles::Markers> markers,
                       MarkerSource& source);
  void apply(ObstacleService::Obstacles obstacles, const ObstacleService::Answer& answer);

  FixedFrame& frame_;
  std::function<void()> on_message_;
  fiber::World world_;
  ObjectTracks tracks_;
  ObstacleSet obstacles_;
  SceneObstacles scene_;
  RobotLinks robot_;
  double pose_timeout_;      // [s]
  double obstacle_timeout_;  // [s]
  double max_stamp_ahead_;   // [s]
  double max_lateness_;      // [s] a change of an object that is there may wait so long
  OwedChanges owed_;
  std::string obstacle_topic_name_;
  ChangeTopic obstacle_topic_;
  WaitingChanges changes_;  // of topic and service
  std::vector<std::unique_ptr<MarkerSource>> markers_;
  std::unique_ptr<CloudInput> cloud_;
  std::vector<Unknown> left_out_;
  bool has_scene_;
  bool has_robot_;
  bool is_configured_;
  bool was_changed_ = false;
  ros::Time last_time_;

  // Last: their threads and callbacks use all of the above.
  Worker mesh_builder_;
  std::unique_ptr<ObstacleService> obstacle_service_;
  std::vector<ros::Subscriber> subscribers_;
  std::unique_ptr<AllowedPairsService> allowed_;
};

}  // namespace fiber_proximity_ros
