#include "src/ros/sim/sim_forces.hpp"

#include <algorithm>
#include <cctype>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

/// Two fibres whose names differ by what is not allowed in a topic's name have different indices.
std::string topic_name(const fiber::SimScene& scene, std::uint32_t rod, std::uint32_t node) {
  const auto allowed = [](const std::string& name) {
    std::string text = name;
    std::replace_if(
        text.begin(), text.end(),
        [](unsigned char letter) { return std::isalnum(letter) == 0 && letter != '_'; }, '_');
    return text;
  };
  const std::vector<std::string>& names = scene.fiber_names;
  std::string name = allowed(names[rod]);
  const auto is_same = [&](const std::string& other) { return allowed(other) == name; };
  if (std::count_if(names.begin(), names.end(), is_same) > 1) {
    name += "_" + std::to_string(rod);
  }
  return "wrenches/" + name + "/" + std::to_string(node);
}

/// Columns: tangent, director and what is across both.
Matrix3d axes_of(const fiber::Placement& placement) {
  Matrix3d axes;
  axes << placement.tangent, placement.director, placement.tangent.cross(placement.director);
  return axes;
}

}  // namespace

geometry_msgs::WrenchStamped wrench_of(const fiber::SimScene& scene,
                                       const fiber::RodForces::HoldForce& hold,
                                       const std_msgs::Header& header) {
  geometry_msgs::WrenchStamped message;
  message.header = header;
  Vector3d force = -hold.force;
  Vector3d moment = -hold.moment;
  const auto followed = std::find_if(
      scene.frames.begin(), scene.frames.end(),
      [&hold](const auto& each) { return each.rod == hold.rod && each.node == hold.node; });
  if (followed != scene.frames.end()) {
    const fiber::Placement& placement = followed->path->back().second;
    const Matrix3d turn = axes_of(followed->in_frame) * axes_of(placement).transpose();
    const Vector3d origin = placement.position - turn.transpose() * followed->in_frame.position;
    moment = turn * (moment + (hold.point - origin).cross(force));
    force = turn * force;
    message.header.frame_id = followed->frame;
  }
  message.wrench.force = to_vector_message(force);
  message.wrench.torque = to_vector_message(moment);
  return message;
}

void to_message(const fiber::SimScene& scene, const fiber::RodForces& forces,
                fiber_proximity::ForceArray& message) {
  const fiber::Rods& rods = scene.stepper->rods();
  message.names = scene.fiber_names;
  message.offsets = rods.offsets;
  message.tensions = forces.tensions;
  message.twisting_moments = forces.twisting_moments;
  message.bending_moments.clear();
  for (const Vector3d& moment : forces.bending_moments) {
    message.bending_moments.push_back(to_vector_message(moment));
  }
  message.contacts.clear();
  for (const fiber::RodForces::ContactForce& force : forces.contacts) {
    fiber_proximity::ContactForce& contact = message.contacts.emplace_back();
    contact.fiber = force.rod;
    contact.segment = force.edge;
    if (force.other_rod == fiber::RodForces::ContactForce::obstacle) {
      contact.object = scene.environment->objects()[force.object].name;
    } else {
      contact.other_fiber = force.other_rod;
      contact.other_segment = force.other_edge;
    }
    contact.point = to_message(force.point);
    contact.normal_force = to_vector_message(force.normal_force);
    contact.friction_force = to_vector_message(force.friction_force);
  }
  message.holds.clear();
  for (const fiber::RodForces::HoldForce& force : forces.holds) {
    fiber_proximity::HoldForce& hold = message.holds.emplace_back();
    hold.fiber = force.rod;
    hold.node = force.node;
    hold.point = to_message(force.point);
    hold.force = to_vector_message(force.force);
    hold.moment = to_vector_message(force.moment);
    hold.lag = force.lag;
    hold.max_force = force.most;
  }
  const fiber::IslandReport& worst = scene.stepper->report().worst;
  message.residual = worst.residual;
  message.residual_fiber = worst.rod;
  message.residual_node = worst.node;
  message.residual_force = scene.residual_force();
  message.energy_gain = scene.stepper->report().energy_gain;
}

SimForces::SimForces(const ros::NodeHandle& node) : node_(node) {
  forces_ = node_.advertise<fiber_proximity::ForceArray>("forces", 1);
  drawing_ = node_.advertise<visualization_msgs::MarkerArray>("force_markers", 1);
}

/// Holds come and go by ~attach and ~detach; the topic of one that has gone is silent.
void SimForces::advertise_wrenches(const fiber::SimScene& scene) {
  if (scene.attachment == nullptr) {
    return;
  }
  for (const Hold& hold : scene.attachment->held_nodes()) {
    wrench_topic(scene, hold);
  }
}

ros::Publisher& SimForces::wrench_topic(const fiber::SimScene& scene, const Hold& hold) {
  ros::Publisher& publisher = wrenches_[hold];
  if (!publisher) {
    publisher = node_.advertise<geometry_msgs::WrenchStamped>(
        topic_name(scene, hold.first, hold.second), 1);
  }
  return publisher;
}

bool SimForces::has_listeners() const {
  return forces_.getNumSubscribers() > 0 || drawing_.getNumSubscribers() > 0 ||
         std::any_of(wrenches_.begin(), wrenches_.end(),
                     [](const auto& each) { return each.second.getNumSubscribers() > 0; });
}

void SimForces::publish(const fiber::SimScene& scene, const std_msgs::Header& header) {
  advertise_wrenches(scene);
  if (!has_listeners()) {
    return;
  }
  const fiber::RodForces forces = scene.stepper->forces();
  if (forces_.getNumSubscribers() > 0) {
    message_.header = header;
    to_message(scene, forces, message_);
    forces_.publish(message_);
  }
  for (const fiber::RodForces::HoldForce& hold : forces.holds) {
    wrench_topic(scene, {hold.rod, hold.node}).publish(wrench_of(scene, hold, header));
  }
  if (drawing_.getNumSubscribers() > 0) {
    markers_.draw(scene, forces, header, drawn_);
    drawing_.publish(drawn_);
  }
}

}  // namespace fiber_proximity_ros
