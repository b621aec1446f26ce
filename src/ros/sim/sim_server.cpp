#include "src/ros/sim/sim_server.hpp"

#include <ros/console.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <exception>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/environment/environment_options.hpp"
#include "src/ros/environment/obstacle_change.hpp"
#include "src/ros/sim/make_sim_server.hpp"
#include "src/ros/support/parameters.hpp"
#include "src/sim/scene/report.hpp"
#include "src/text/join.hpp"
#include "src/text/with_context.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;

/// [s] How often a warning is repeated.
constexpr double warning_pause = 5.0;

/// The period in which handles are moved: rviz takes far longer for them than for fibres.
const ros::WallDuration marker_period(1.0 / 30.0);

/// Logs the scene's contents, and what to expect of it: that is measured on a copy, as the log
/// says.
void log_scene(const SimOptions& options, const fiber::SimDescription& description,
               const fiber::SimScene& scene) {
  const fiber::Rods& rods = scene.stepper->rods();
  ROS_INFO_STREAM(options.scene << ": " << rods.count() << " fibre(s), " << rods.positions.size()
                                << " nodes, effects " << fiber::join(scene.effect_names) << ", "
                                << scene.substeps << " steps of " << scene.step_length() << " s");
  constexpr std::uint32_t max_logged = 10;
  for (std::uint32_t rod = 0; rod < std::min(max_logged, rods.count()); ++rod) {
    const fiber::RodSection& section = rods.sections[rod];
    ROS_INFO_STREAM("fibre '" << scene.fiber_names[rod] << "': EA " << section.stretching_stiffness
                              << " N, EI " << section.bending_stiffness << " N m^2, GJ "
                              << section.twisting_stiffness << " N m^2, " << section.mass_per_length
                              << " kg/m");
  }
  if (scene.accuracy && scene.real_time_note.empty() && scene.real_time_warning.empty()) {
    ROS_INFO_STREAM(
        "segments and substeps that the scene leaves open are chosen for an accuracy of "
        << 100.0 * *scene.accuracy << " %");
  }
  if (!scene.overlap_note.empty()) {
    ROS_INFO_STREAM(scene.overlap_note);
  }
  const fiber::SimReport expected =
      fiber::report(scene, fiber::try_scene(description, options.threads));
  for (const std::string& fact : expected.facts) {
    ROS_INFO_STREAM(fact);
  }
  for (const std::string& warning : expected.warnings) {
    ROS_WARN_STREAM(options.scene << ": " << warning);
  }
}

}  // namespace

SimOptions read_sim_options(const ros::NodeHandle& node, const ros::NodeHandle& private_node) {
  const Parameters parameters(private_node, interface_of("cable_sim"));
  SimOptions options;
  parameters.read("scene", options.scene);
  if (options.scene.empty()) {
    parameters.refuse("scene");
  }
  parameters.read("threads", options.threads);
  parameters.read("clock", options.clock);
  parameters.read("paused", options.paused);
  parameters.read("interactive", options.interactive);
  parameters.read("frame_timeout", options.frame_timeout);
  parameters.read("frame_wait", options.frame_wait);
  options.meshes = read_mesh_folders(parameters);
  options.links = robot_links(node, options.meshes);
  return options;
}

fiber::SimDescription read_scene(const SimOptions& options) {
  return fiber::read_sim_scene(fiber::load_yaml(options.scene), options.meshes, {}, options.links);
}

std::shared_ptr<void> make_sim_server(const ros::NodeHandle& node,
                                      const ros::NodeHandle& private_node) {
  return std::make_shared<SimServer>(node, private_node, read_sim_options(node, private_node));
}

SimServer::SimServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const SimOptions& options)
    : SimServer(node, private_node, options,
                fiber::with_context("parameter " + private_node.resolveName("scene"),
                                    [&options] { return read_scene(options); })) {}

SimServer::SimServer(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                     const SimOptions& options, const fiber::SimDescription& description)
    : node_(private_node),
      options_(options),
      description_(std::make_shared<const fiber::SimDescription>(description)),
      scene_(fiber::make_sim_scene(description, options.threads)),
      world_(scene_.frame_id, private_node),
      frames_(world_, options.frame_timeout),
      added_(node, world_, options.frame_wait),
      is_paused_(options.paused),
      next_frame_(ros::SteadyTime::now()),
      forces_(private_node) {
  frames_.wait_for(description, scene_, options.frame_wait);
  log_scene(options_, description, scene_);
  fibers_ = OutputTopic<fiber_proximity::FiberArray>(
      node_.advertise<fiber_proximity::FiberArray>("fibers", 1, true));
  if (options_.clock) {
    clock_ = node_.advertise<rosgraph_msgs::Clock>("/clock", 1);
  }
  obstacles_ = node_.advertise<fiber_proximity::ObstacleArray>("obstacles", 2, true);
  publish();
  publish_obstacles();
  make_markers();
  advertise_services();
  timer_ = node_.createSteadyTimer(ros::WallDuration(scene_.time_step),
                                   [this](const ros::SteadyTimerEvent&) { keep_pace(); });
  marker_timer_ = node_.createSteadyTimer(
      marker_period, [this](const ros::SteadyTimerEvent&) { update_markers(); });
  step_spinner_.start();
}

SimServer::~SimServer() { is_ending_ = true; }

/// The scene as it is between two frames.
SceneCopy SimServer::copy_scene() {
  const std::lock_guard<FairMutex> lock(mutex_);
  require_running();
  constexpr std::uint32_t threads = 1;  // several are made at once
  return {fiber::copy_sim_scene(*description_, scene_, threads), header_};
}

void SimServer::keep_pace() {
  clock_watch_.look();
  const std::lock_guard<FairMutex> lock(mutex_);
  if (is_paused_ || is_stepping_ || !failure_.empty()) {
    next_frame_ = ros::SteadyTime::now();
    return;
  }
  try {
    advance();
  } catch (const std::runtime_error&) {
    return;  // it was logged, and services say so
  }
  next_frame_ += ros::WallDuration(scene_.time_step);
  const double late = (ros::SteadyTime::now() - next_frame_).toSec();
  // The timer makes up for frames that came a little late.
  if (late > scene_.time_step) {
    behind_ += late;
    next_frame_ = ros::SteadyTime::now();
    ROS_WARN_STREAM_THROTTLE(warning_pause, "the simulation is slower than real time: "
                                                << behind_ << " s behind after "
                                                << scene_.stepper->time() << " s of the scene");
  }
}

void SimServer::update_markers() {
  const std::lock_guard<FairMutex> lock(mutex_);
  if (markers_ != nullptr && failure_.empty()) {
    markers_->update(scene_);
  }
}

void SimServer::require_running() const {
  if (!failure_.empty()) {
    throw std::runtime_error("the simulation has stopped " + failure_ + "; ~reset begins again");
  }
}

void SimServer::advance() {
  require_running();
  std::ostringstream failure;
  failure << "after " << scene_.stepper->time() << " s of the scene: ";
  try {
    run_frame();
  } catch (const std::exception& error) {
    failure_ = failure.str() + error.what();
    ROS_ERROR_STREAM("the simulation has stopped " << failure_ << "; ~reset begins again");
    require_running();
  }
}

void SimServer::run_frame() {
  frames_.follow(scene_);
  const bool had_motions = scene_.motions() != nullptr;
  added_.apply(*description_, scene_);
  if (markers_ != nullptr) {
    markers_->apply(scene_);
  }
  scene_.advance();
  publish();
  if (had_motions || scene_.motions() != nullptr) {
    publish_obstacles();
  }
  forces_.publish(scene_, header_);
  warn();
}

/// Logs warnings, each kind of them not too often.
void SimServer::warn() {
  const ros::SteadyTime now = ros::SteadyTime::now();
  for (const fiber::SimWarning& warning : fiber::frame_warnings(scene_)) {
    ros::SteadyTime& last = warned_[static_cast<std::size_t>(warning.kind)];
    if (last.isZero() || (now - last).toSec() >= warning_pause) {
      last = now;
      ROS_WARN_STREAM(warning.text);
    }
  }
}

void SimServer::publish() {
  const fiber::Rods& rods = scene_.stepper->rods();
  header_.frame_id = scene_.frame_id;
  header_.stamp = ros::Time::now();
  if (options_.clock) {
    rosgraph_msgs::Clock clock;
    clock.clock = ros::Time(scene_.stepper->time());
    header_.stamp = clock.clock;
    clock_.publish(clock);
  }
  fiber_proximity::FiberArray& message = fibers_.message();
  to_message(fiber::assembly_of(rods), scene_.fiber_names, message);
  message.header = header_;
  fibers_.publish();
}

/// Those that are no longer there are removed, in a message of its own: whoever comes later gets
/// the last one, and has none to remove.
void SimServer::publish_obstacles() {
  fiber_proximity::ObstacleArray present;
  std::set<std::string> gone = std::exchange(obstacle_names_, {});
  for (const fiber::EnvironmentObject& object : scene_.objects()) {
    present.obstacles.push_back(to_obstacle(object, scene_.frame_id));
    obstacle_names_.insert(object.name);
    gone.erase(object.name);
  }
  fiber_proximity::ObstacleArray removed;
  for (const std::string& name : gone) {
    removed.obstacles.emplace_back();
    removed.obstacles.back().id = name;
    removed.obstacles.back().operation = fiber_proximity::Obstacle::REMOVE;
  }
  if (!gone.empty()) {
    obstacles_.publish(removed);
  }
  obstacles_.publish(present);
}

void SimServer::make_markers() {
  if (!options_.interactive || scene_.attachment == nullptr) {
    markers_.reset();
    return;
  }
  if (markers_ == nullptr) {
    markers_ = std::make_unique<SimMarkers>(node_.resolveName("interactive_markers"), world_);
  }
  markers_->begin(scene_);
}

}  // namespace fiber_proximity_ros
