#include "src/python/simulation.hpp"

#include <algorithm>
#include <stdexcept>
#include <utility>

#include "src/sim/scene/reach.hpp"
#include "src/text/quote.hpp"

namespace fiber::python {

Simulation::Simulation(SimDescription description, std::uint32_t threads)
    : description_(std::move(description)),
      threads_(threads),
      scene_(make_sim_scene(description_, threads)) {
  if (!scene_.obstacle_frames.empty()) {
    const FollowedObstacle& followed = scene_.obstacle_frames.front();
    throw std::invalid_argument(followed.what + " follows frame " + quote(followed.frame) +
                                " of tf: that is for cable_sim, here it must have a path");
  }
  if (!scene_.frames.empty()) {
    const FollowedFrame& frame = scene_.frames.front();
    throw std::invalid_argument(frame.what + " follows frame " + quote(frame.frame) +
                                " of tf: that is for cable_sim, here it must be held by a path, "
                                "or by attach()");
  }
}

void Simulation::require_running() const {
  if (!failure_.empty()) {
    throw std::runtime_error("the simulation has failed, reset() begins it again: " + failure_);
  }
}

void Simulation::step(std::uint32_t frames) {
  const WithoutPythonLock others_may_run;
  for (std::uint32_t i = 0; i < frames; ++i) {
    const std::lock_guard<std::mutex> lock(mutex_);
    require_running();
    try {
      scene_.advance();
    } catch (const std::runtime_error& error) {
      failure_ = error.what();
      throw;
    }
  }
}

SimScene Simulation::copy() const {
  return with([this](const SimScene& scene) { return copy_sim_scene(description_, scene, 1); });
}

void Simulation::reset() {
  const WithoutPythonLock others_may_run;
  SimScene scene = make_sim_scene(description_, threads_);
  const std::lock_guard<std::mutex> lock(mutex_);
  scene_ = std::move(scene);
  failure_.clear();
}

namespace {

/// Straight to the target from where the node is.
Attachment::Hold make_hold(const SimScene& scene, const NodeOfRod& held,
                           const HoldRequest& request) {
  const Rods& rods = scene.stepper->rods();
  const Eigen::Vector3d from = rods.positions[rods.first(held.rod) + held.node];
  Attachment::Hold hold;
  hold.rod = held.rod;
  hold.node = held.node;
  hold.max_force = request.max_force;
  Placement placement{from, Eigen::Vector3d::UnitX(), Eigen::Vector3d::UnitY()};
  if (request.tangent) {
    hold.kind = Attachment::Kind::CLAMP;
    if (!request.director && !rods.directors.empty()) {
      throw std::invalid_argument("the fibres twist: a clamp needs a director");
    }
    placement.tangent = *request.tangent;
    placement.director = request.director ? *request.director : request.tangent->unitOrthogonal();
  }
  const Eigen::Vector3d way = request.target - from;
  const double start = scene.stepper->time();
  hold.placement = [placement, way, start, speed = request.speed](double time) {
    const double length = way.norm();
    const double share =
        speed > 0.0 && length > 0.0 ? std::clamp(speed * (time - start) / length, 0.0, 1.0) : 1.0;
    Placement moved = placement;
    moved.position += share * way;
    return moved;
  };
  return hold;
}

}  // namespace

void attach(SimScene& scene, std::uint32_t rod, std::int64_t node, const HoldRequest& request) {
  const NodeOfRod held = find_node(scene, rod, node);
  if (!request.target.allFinite() || !(request.speed >= 0.0)) {
    throw std::invalid_argument("position must be finite and speed at least 0");
  }
  require_reach(scene, held, request.target, request.speed);
  const Attachment::Hold hold = make_hold(scene, held, request);
  const Rods& rods = scene.stepper->rods();
  Attachment without = *scene.attachment;  // so that one that is refused changes nothing
  const auto replaced = without.find(held.rod, held.node);
  if (replaced) {
    without.remove(*replaced);
  }
  without.add(rods, hold);
  *scene.attachment = std::move(without);
  if (replaced) {
    scene.paths.erase(*replaced);
  }
}

}  // namespace fiber::python
