#include "fiber_proximity/ros/sim_server.hpp"

#include <ros/console.h>
#include <rosgraph_msgs/Clock.h>

#include <algorithm>
#include <exception>
#include <stdexcept>

#include "fiber_proximity/ObstacleArray.h"
#include "fiber_proximity/ros/conversions.hpp"
#include "fiber_proximity/ros/environment_options.hpp"
#include "fiber_proximity/ros/listed.hpp"
#include "fiber_proximity/ros/parameters.hpp"
#include "fiber_proximity/ros/sim_report.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;

/// [s] How often a warning is repeated.
constexpr double warning_period = 5.0;

/// How often handles are moved: rviz takes far longer for them than for fibres.
const ros::WallDuration marker_period(1.0 / 30.0);

/// Runs what a service was asked for; its error is the answer.
template <class Response, class Function>
bool answer(Response& response, const Function& function) {
  try {
    function();
    response.success = true;
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  return true;
}

}  // namespace

SimOptions read_sim_options(const ros::NodeHandle& private_node) {
  SimOptions options;
  read_parameter(private_node, "scene", "the name of a YAML file", options.scene);
  if (options.scene.empty()) {
    refuse_parameter(private_node, "scene", "the name of a YAML file");
  }
  read_parameter(private_node, "threads", options.threads);
  read_parameter(private_node, "clock", "true or false", options.clock);
  read_parameter(private_node, "paused", "true or false", options.paused);
  read_parameter(private_node, "interactive", "true or false", options.interactive);
  read_parameter(private_node, "frame_timeout", 0.0, options.frame_timeout);
  read_parameter(private_node, "frame_wait", 0.0, options.frame_wait);
  options.meshes = read_mesh_folders(private_node);
  return options;
}

SimServer::SimServer(const ros::NodeHandle& private_node, const SimOptions& options)
    : node_(private_node),
      options_(options),
      scene_(read_sim_scene(options.scene, options.meshes, options.threads)),
      world_(scene_.frame_id, private_node),
      frames_(world_, options.frame_timeout),
      is_paused_(options.paused),
      next_frame_(ros::SteadyTime::now()) {
  frames_.wait_for(scene_.frames, options.frame_wait);
  log_scene();
  fibers_ = node_.advertise<fiber_proximity::FiberArray>("fibers", 1, true);
  if (options_.clock) {
    clock_ = node_.advertise<rosgraph_msgs::Clock>("/clock", 1);
  }
  obstacles_ = node_.advertise<fiber_proximity::ObstacleArray>("obstacles", 1, true);
  publish();
  publish_obstacles({});
  make_markers();
  servers_.push_back(node_.advertiseService("reset", &SimServer::reset, this));
  servers_.push_back(node_.advertiseService("pause", &SimServer::pause, this));
  servers_.push_back(node_.advertiseService("step", &SimServer::step, this));
  servers_.push_back(node_.advertiseService("attach", &SimServer::attach, this));
  servers_.push_back(node_.advertiseService("detach", &SimServer::detach, this));
  servers_.push_back(node_.advertiseService("set_parameters", &SimServer::set_parameters, this));
  timer_ = node_.createSteadyTimer(ros::WallDuration(scene_.time_step),
                                   [this](const ros::SteadyTimerEvent&) { keep_pace(); });
  marker_timer_ = node_.createSteadyTimer(marker_period, [this](const ros::SteadyTimerEvent&) {
    if (markers_ != nullptr) {
      markers_->update(scene_);
    }
  });
}

void SimServer::log_scene() const {
  const fiber::Rods& rods = scene_.stepper->rods();
  ROS_INFO_STREAM(options_.scene << ": " << rods.count() << " fibre(s), " << rods.positions.size()
                                 << " nodes, effects " << listed(scene_.effect_names) << ", "
                                 << scene_.substeps << " steps of "
                                 << scene_.time_step / scene_.substeps << " s");
  constexpr std::uint32_t most = 10;
  for (std::uint32_t rod = 0; rod < std::min(most, rods.count()); ++rod) {
    const fiber::RodSection& section = rods.sections[rod];
    ROS_INFO_STREAM("fibre '" << scene_.fiber_names[rod] << "': EA " << section.stretching_stiffness
                              << " N, EI " << section.bending_stiffness << " N m^2, GJ "
                              << section.twisting_stiffness << " N m^2, " << section.mass_per_length
                              << " kg/m");
  }
  if (scene_.accuracy) {
    ROS_INFO_STREAM(
        "segments and substeps that the scene leaves open are chosen for an accuracy of "
        << 100.0 * *scene_.accuracy << " %");
  }
  const SimReport expected =
      report(scene_, try_scene(options_.scene, options_.meshes, options_.threads));
  for (const std::string& fact : expected.facts) {
    ROS_INFO_STREAM(fact);
  }
  for (const std::string& warning : expected.warnings) {
    ROS_WARN_STREAM(options_.scene << ": " << warning);
  }
}

void SimServer::keep_pace() {
  if (is_paused_) {
    next_frame_ = ros::SteadyTime::now();
    return;
  }
  advance();
  next_frame_ += ros::WallDuration(scene_.time_step);
  const double late = (ros::SteadyTime::now() - next_frame_).toSec();
  // The timer makes up for frames that came a little late.
  if (late > scene_.time_step) {
    behind_ += late;
    next_frame_ = ros::SteadyTime::now();
    ROS_WARN_STREAM_THROTTLE(warning_period, "the simulation is slower than real time: "
                                                 << behind_ << " s behind after "
                                                 << scene_.stepper->time() << " s of the scene");
  }
}

void SimServer::advance() {
  frames_.follow(scene_.frames, {scene_.stepper->time(), scene_.time_step});
  if (markers_ != nullptr) {
    markers_->apply(scene_);
  }
  for (std::uint32_t i = 0; i < scene_.substeps; ++i) {
    scene_.stepper->step(scene_.time_step / scene_.substeps);
  }
  publish();
}

void SimServer::publish() {
  const fiber::Rods& rods = scene_.stepper->rods();
  to_message(fiber::FiberAssembly(rods.positions, rods.offsets, rods.radii), scene_.fiber_names,
             message_);
  message_.header.frame_id = scene_.frame_id;
  message_.header.stamp = ros::Time::now();
  if (options_.clock) {
    rosgraph_msgs::Clock clock;
    clock.clock = ros::Time(scene_.stepper->time());
    message_.header.stamp = clock.clock;
    clock_.publish(clock);
  }
  fibers_.publish(message_);
}

/// @param before what was published of the scene before, of which what is no longer there goes
void SimServer::publish_obstacles(const std::vector<fiber_proximity::Obstacle>& before) {
  fiber_proximity::ObstacleArray message;
  for (const fiber_proximity::Obstacle& old : before) {
    const auto is_same = [&old](const auto& obstacle) { return obstacle.id == old.id; };
    if (std::none_of(scene_.obstacles.begin(), scene_.obstacles.end(), is_same)) {
      message.obstacles.emplace_back();
      message.obstacles.back().id = old.id;
      message.obstacles.back().operation = fiber_proximity::Obstacle::REMOVE;
    }
  }
  message.obstacles.insert(message.obstacles.end(), scene_.obstacles.begin(),
                           scene_.obstacles.end());
  obstacles_.publish(message);
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

SimServer::NodeOfRod SimServer::find_node(const std::string& fiber, std::int32_t node) const {
  const auto& names = scene_.fiber_names;
  const auto found = std::find(names.begin(), names.end(), fiber);
  if (found == names.end()) {
    throw std::invalid_argument("there is no fibre '" + fiber + "'");
  }
  const auto rod = static_cast<std::uint32_t>(found - names.begin());
  const auto count = static_cast<std::int64_t>(scene_.stepper->rods().node_count(rod));
  const std::int64_t index = node < 0 ? count + node : node;
  if (index < 0 || index >= count) {
    throw std::invalid_argument("fibre '" + fiber + "' has " + std::to_string(count) +
                                " nodes, there is no node " + std::to_string(node));
  }
  if (scene_.attachment == nullptr) {
    throw std::invalid_argument("the scene does not name the effect attachment");
  }
  return {rod, static_cast<std::uint32_t>(index)};
}

bool SimServer::reset(std_srvs::Trigger::Request& /*request*/,
                      std_srvs::Trigger::Response& response) {
  return answer(response, [this] {
    SimScene scene = read_sim_scene(options_.scene, options_.meshes, options_.threads);
    frames_.wait_for(scene.frames, 0.0);
    std::swap(scene_, scene);
    publish();
    publish_obstacles(scene.obstacles);
    make_markers();
  });
}

bool SimServer::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  is_paused_ = request.data;
  response.success = true;
  return true;
}

bool SimServer::step(fiber_proximity::StepSimulation::Request& request,
                     fiber_proximity::StepSimulation::Response& response) {
  for (std::uint32_t i = 0; i < request.frames; ++i) {
    advance();
  }
  response.success = true;
  response.time = scene_.stepper->time();
  return true;
}

bool SimServer::attach(fiber_proximity::AttachFiber::Request& request,
                       fiber_proximity::AttachFiber::Response& response) {
  return answer(response, [&] {
    const NodeOfRod held = find_node(request.fiber, request.node);
    const Vector3d target = to_vector(request.position);
    if (!target.allFinite() || !(request.speed >= 0.0)) {
      throw std::invalid_argument("position must be finite and speed at least 0");
    }
    const fiber::Rods& rods = scene_.stepper->rods();
    const Vector3d from = rods.positions[rods.first(held.rod) + held.node];
    const double start = scene_.stepper->time();
    const double way = (target - from).norm();
    const double speed = request.speed;
    fiber::Attachment::Hold hold;
    hold.rod = held.rod;
    hold.node = held.node;
    hold.placement = [=](double time) {
      const double share = speed > 0.0 && way > 0.0
                               ? std::min(1.0, std::max(0.0, speed * (time - start) / way))
                               : 1.0;
      return fiber::Placement{from + share * (target - from), Vector3d::UnitX(), Vector3d::UnitY()};
    };
    if (const auto id = scene_.attachment->find(held.rod, held.node)) {
      scene_.attachment->remove(*id);
    }
    scene_.attachment->add(rods, hold);
  });
}

bool SimServer::detach(fiber_proximity::DetachFiber::Request& request,
                       fiber_proximity::DetachFiber::Response& response) {
  return answer(response, [&] {
    const NodeOfRod held = find_node(request.fiber, request.node);
    const auto id = scene_.attachment->find(held.rod, held.node);
    if (!id) {
      throw std::invalid_argument("nothing holds node " + std::to_string(request.node) +
                                  " of fibre '" + request.fiber + "'");
    }
    scene_.attachment->remove(*id);
  });
}

bool SimServer::set_parameters(fiber_proximity::SetSimulationParameters::Request& request,
                               fiber_proximity::SetSimulationParameters::Response& response) {
  answer(response, [&] { scene_.parameters.set(request.parameters); });
  response.parameters = scene_.parameters.all();
  return true;
}

}  // namespace fiber_proximity_ros
