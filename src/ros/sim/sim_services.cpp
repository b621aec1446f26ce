// The services of the simulation.
#include <ros/init.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <mutex>
#include <stdexcept>

#include "fiber_proximity/ros/conversions.hpp"
#include "src/ros/sim/sim_server.hpp"
#include "src/sim/scene/reach.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Vector3d;

/// More than four hours of a scene of 60 Hz: beyond that, a number is rather a mistake.
constexpr std::uint32_t max_frames_of_a_call = 1000000;

/// Errors name what they refuse, which may be of any length.
std::string shortened(const std::string& text) {
  constexpr std::size_t longest = 500;
  return text.size() <= longest ? text : text.substr(0, longest) + "...";
}

/// Runs what a service was asked for; its error is the answer.
template <class Response, class Function>
bool answer(Response& response, const Function& function) {
  try {
    function();
    response.success = true;
  } catch (const std::exception& error) {
    response.success = false;
    response.message = shortened(error.what());
  }
  return true;
}

/// Has a scene hold a node where a request says.
void hold(const fiber_proximity::AttachFiber::Request& request, fiber::SimScene& scene) {
  const fiber::NodeOfRod held =
      fiber::find_node(scene, fiber::find_rod(scene, request.fiber), request.node);
  const Vector3d target = to_vector(request.position);
  if (!target.allFinite() || !(request.speed >= 0.0)) {
    throw std::invalid_argument("position must be finite and speed at least 0");
  }
  fiber::require_reach(scene, held, target, request.speed);
  const Vector3d from = fiber::position_of(scene.stepper->rods(), held);
  const double time = scene.stepper->time();
  const auto path = std::make_shared<fiber::PlacementPath>();
  path->emplace_back(time, fiber::Placement{target, Vector3d::UnitX(), Vector3d::UnitY()});
  if (request.speed > 0.0) {
    path->insert(path->begin(), path->front());
    path->front().second.position = from;
    path->back().first += (target - from).norm() / request.speed;
  }
  fiber::hold_on_path(scene, held, path);
}

}  // namespace

void SimServer::advertise_services() {
  servers_.push_back(node_.advertiseService("reset", &SimServer::reset, this));
  servers_.push_back(node_.advertiseService("pause", &SimServer::pause, this));
  servers_.push_back(node_.advertiseService("attach", &SimServer::attach, this));
  servers_.push_back(node_.advertiseService("detach", &SimServer::detach, this));
  servers_.push_back(node_.advertiseService("set_parameters", &SimServer::set_parameters, this));
  ros::NodeHandle own_thread(node_);
  own_thread.setCallbackQueue(&step_queue_);
  servers_.push_back(own_thread.advertiseService("step", &SimServer::step, this));
  predict_service_ = std::make_unique<PredictService>(
      node_, [this] { return copy_scene(); }, [this] { return is_ending_ || !ros::ok(); });
}

bool SimServer::reset(std_srvs::Trigger::Request& /*request*/,
                      std_srvs::Trigger::Response& response) {
  return answer(response, [this] {
    // The file is read without the mutex: that may take long.
    const auto description = std::make_shared<const fiber::SimDescription>(read_scene(options_));
    fiber::SimScene scene = fiber::make_sim_scene(*description, options_.threads);
    frames_.wait_for(*description, scene, 0.0);
    const std::lock_guard<FairMutex> lock(mutex_);
    std::swap(scene_, scene);
    description_ = description;
    forces_.begin();
    failure_.clear();
    interruption_ = "~reset began the scene again";
    added_.begin(*description_, scene_);
    publish();
    publish_obstacles();
    make_markers();
  });
}

bool SimServer::pause(std_srvs::SetBool::Request& request, std_srvs::SetBool::Response& response) {
  return answer(response, [&] {
    const std::lock_guard<FairMutex> lock(mutex_);
    is_paused_ = request.data != 0;
    if (is_paused_) {
      interruption_ = "~pause ended it";
    }
    require_running();
  });
}

void SimServer::step_frames(std::uint32_t count) {
  if (count > max_frames_of_a_call) {
    throw std::invalid_argument("frames is " + std::to_string(count) + ", it must be at most " +
                                std::to_string(max_frames_of_a_call));
  }
  interruption_.clear();
  for (std::uint32_t i = 0; i < count; ++i) {
    advance();
    mutex_.unlock();  // whoever waits has a turn
    mutex_.lock();
    if (is_ending_ || !ros::ok()) {
      interruption_ = "the node ends";
    }
    if (!interruption_.empty() && i + 1 < count) {
      throw std::runtime_error(interruption_ + " after " + std::to_string(i + 1) + " of " +
                               std::to_string(count) + " frames");
    }
  }
  require_running();
}

bool SimServer::step(fiber_proximity::StepSimulation::Request& request,
                     fiber_proximity::StepSimulation::Response& response) {
  const std::lock_guard<FairMutex> lock(mutex_);
  is_stepping_ = true;
  answer(response, [&] { step_frames(request.frames); });
  is_stepping_ = false;
  response.time = scene_.stepper->time();
  return true;
}

bool SimServer::attach(fiber_proximity::AttachFiber::Request& request,
                       fiber_proximity::AttachFiber::Response& response) {
  return answer(response, [&] {
    const std::lock_guard<FairMutex> lock(mutex_);
    require_running();
    hold(request, scene_);
  });
}

bool SimServer::detach(fiber_proximity::DetachFiber::Request& request,
                       fiber_proximity::DetachFiber::Response& response) {
  return answer(response, [&] {
    const std::lock_guard<FairMutex> lock(mutex_);
    require_running();
    fiber::release_node(scene_, fiber::find_rod(scene_, request.fiber), request.node);
  });
}

bool SimServer::set_parameters(fiber_proximity::SetSimulationParameters::Request& request,
                               fiber_proximity::SetSimulationParameters::Response& response) {
  const std::lock_guard<FairMutex> lock(mutex_);
  answer(response, [&] {
    require_running();
    std::vector<fiber::SimParameter> parameters;
    for (const fiber_proximity::SimulationParameter& parameter : request.parameters) {
      parameters.push_back({parameter.name, parameter.value});
    }
    scene_.parameters.set(parameters);
  });
  for (const fiber::SimParameter& parameter : scene_.parameters.all()) {
    response.parameters.emplace_back();
    response.parameters.back().name = parameter.name;
    response.parameters.back().value = parameter.value;
  }
  return true;
}

}  // namespace fiber_proximity_ros
