#pragma once

#include <ros/callback_queue.h>
#include <ros/node_handle.h>
#include <ros/spinner.h>
#include <std_srvs/SetBool.h>
#include <std_srvs/Trigger.h>

#include <array>
#include <atomic>
#include <set>
#include <string>

#include "fiber_proximity/AttachFiber.h"
#include "fiber_proximity/DetachFiber.h"
#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/SetSimulationParameters.h"
#include "fiber_proximity/StepSimulation.h"
#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/ros/environment/mesh_loader.hpp"
#include "src/ros/inputs/fixed_frame.hpp"
#include "src/ros/outputs/output_topic.hpp"
#include "src/ros/sim/fair_mutex.hpp"
#include "src/ros/sim/predict_service.hpp"
#include "src/ros/sim/sim_forces.hpp"
#include "src/ros/sim/sim_frames.hpp"
#include "src/ros/sim/sim_markers.hpp"
#include "src/ros/sim/sim_obstacles.hpp"
#include "src/ros/support/clock_watch.hpp"
#include "src/sim/scene/report.hpp"

namespace fiber_proximity_ros {

/// The node's private parameters of the same names, whose defaults are in cfg/interface.yaml.
struct SimOptions {
  std::string scene;        ///< YAML file
  std::uint32_t threads{};  ///< most to use, 0 for as many as there are cores
  bool clock{};             ///< publish /clock, and stamp fibres with the scene's time
  bool paused{};            ///< wait for ~step or ~pause
  bool interactive{};       ///< handles for rviz, if the scene has the effect attachment
  double frame_timeout{};   ///< [s] of wall time without news of a frame that holds something
  double frame_wait{};      ///< [s] of wall time for such frames to come when the scene is loaded
  MeshLoader meshes;        ///< of the environment, from the folders of ~mesh_folders
  fiber::LinkSource links;  ///< of robots, from the parameters that scenes name
};

/// @param node in whose namespace parameters with robots' URDF are
/// @throws std::invalid_argument naming the parameter, its value and what is allowed
SimOptions read_sim_options(const ros::NodeHandle& node, const ros::NodeHandle& private_node);

/// Reads the file of the scene.
/// @throws std::invalid_argument as fiber::load_yaml and fiber::read_sim_scene
fiber::SimDescription read_scene(const SimOptions& options);

/// Stands in for a tracker: moves the fibres of a scene in real time, and publishes ~fibers;
/// ~obstacles, what is around them, once or, where that moves, in each frame; and forces, see
/// SimForces. Others may add obstacles, see SimObstacles.
///
/// A frame that fails, because a step diverges or for whatever else it throws, stops the simulation
/// for good: what was published last stays, services answer with the reason, ~reset begins again.
///
/// ~step has a thread of its own, so that the other callbacks are served between its frames, and
/// ~predict looks ahead in copies.
class SimServer {
 public:
  /// @throws std::invalid_argument as read_scene and fiber::make_sim_scene, and for a frame of tf
  ///         that does not come
  SimServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
            const SimOptions& options);
  /// Begins with a scene of the caller's; ~reset begins with that of the file.
  SimServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
            const SimOptions& options, const fiber::SimDescription& description);
  ~SimServer();
  SimServer(const SimServer&) = delete;
  SimServer& operator=(const SimServer&) = delete;

 private:
  void advertise_services();
  SceneCopy copy_scene();
  void keep_pace();
  void update_markers();

  /// Moves the scene on by a frame. All of these are called with the mutex.
  /// @throws std::runtime_error why the simulation has stopped, in this frame or before
  void advance();
  void run_frame();
  void require_running() const;
  void warn();
  void make_markers();
  void publish();
  void publish_obstacles();

  void step_frames(std::uint32_t count);
  bool reset(std_srvs::Trigger::Request& request, std_srvs::Trigger::Response& response);
  bool pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response);
  bool step(fiber_proximity::StepSimulation::Request& request,
            fiber_proximity::StepSimulation::Response& response);
  bool attach(fiber_proximity::AttachFiber::Request& request,
              fiber_proximity::AttachFiber::Response& response);
  bool detach(fiber_proximity::DetachFiber::Request& request,
              fiber_proximity::DetachFiber::Response& response);
  bool set_parameters(fiber_proximity::SetSimulationParameters::Request& request,
                      fiber_proximity::SetSimulationParameters::Response& response);

  ros::NodeHandle node_;
  SimOptions options_;
  FairMutex mutex_;                                           // of all that follows
  std::shared_ptr<const fiber::SimDescription> description_;  // of the scene
  fiber::SimScene scene_;
  FixedFrame world_;
  SimFrames frames_;
  SimObstacles added_;
  bool is_paused_;
  std::string failure_;         // why the simulation has stopped; empty if it has not
  bool is_stepping_ = false;    // ~step runs
  std::string interruption_;    // why ~step is to end; empty if it is not
  ros::SteadyTime next_frame_;  // when it is due
  double behind_ = 0.0;         // [s] given up so far because steps took too long
  std_msgs::Header header_;     // of the fibres that were published last
  OutputTopic<fiber_proximity::FiberArray> fibers_;
  ros::Publisher obstacles_;
  std::set<std::string> obstacle_names_;  // of those that were published last
  ros::Publisher clock_;
  SimForces forces_;
  std::array<ros::SteadyTime, fiber::SimWarning::kinds> warned_;  // of each kind the last time

  std::unique_ptr<SimMarkers> markers_;  // null without

  // Last: their callbacks use all of the above.
  std::atomic<bool> is_ending_{false};
  ros::CallbackQueue step_queue_;
  std::vector<ros::ServiceServer> servers_;
  ClockWatch clock_watch_;
  ros::SteadyTimer timer_;
  ros::SteadyTimer marker_timer_;
  ros::AsyncSpinner step_spinner_{1, &step_queue_};
  std::unique_ptr<PredictService> predict_service_;
};

}  // namespace fiber_proximity_ros
