#include "src/ros/sim/sim_forces.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <sstream>
#include <vector>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using visualization_msgs::Marker;

constexpr std::size_t max_arrows = 200;  // rviz takes long for more; the largest
constexpr double longest_arrow = 0.25;   // of the scene
constexpr double fading = 0.97;          // of a scale, from drawing to drawing

/// Two whose names differ by what is not allowed in a topic's name have different indices.
std::string allowed_name(const std::vector<std::string>& names, std::size_t index) {
  const auto allowed = [](const std::string& name) {
    std::string text = name;
    std::replace_if(
        text.begin(), text.end(),
        [](unsigned char letter) { return std::isalnum(letter) == 0 && letter != '_'; }, '_');
    return text;
  };
  std::string name = allowed(names[index]);
  const auto is_same = [&](const std::string& other) { return allowed(other) == name; };
  if (std::count_if(names.begin(), names.end(), is_same) > 1) {
    name += "_" + std::to_string(index);
  }
  return name;
}

std::string topic_name(const fiber::SimScene& scene, std::uint32_t rod, std::uint32_t node) {
  return "wrenches/" + allowed_name(scene.fiber_names, rod) + "/" + std::to_string(node);
}

geometry_msgs::WrenchStamped wrench_of(const fiber::RodForces::ObstacleForce& obstacle,
                                       const std_msgs::Header& header) {
  geometry_msgs::WrenchStamped message;
  message.header = header;
  message.wrench.force = to_vector_message(obstacle.force);
  message.wrench.torque = to_vector_message(obstacle.moment);
  return message;
}

/// Columns: tangent, director and what is across both.
Matrix3d axes_of(const fiber::Placement& placement) {
  Matrix3d axes;
  axes << placement.tangent, placement.director, placement.tangent.cross(placement.director);
  return axes;
}

/// The wrench of the fibre on a hold; see SimForces.
/// @param header of what is in the scene's frame
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

/// Writes the fields that holds, joints and loads have alike: the node, where it is, and what acts
/// there.
template <class Force, class Message>
void fill_in_wrench(const Force& force, Message& message) {
  message.fiber = force.rod;
  message.node = force.node;
  message.point = to_message(force.point);
  message.force = to_vector_message(force.force);
  message.moment = to_vector_message(force.moment);
}

/// Memory of the message is reused.
void fill_in(const fiber::SimScene& scene, const fiber::RodForces& forces,
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
      contact.object = scene.object_name(force.object);
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
    fill_in_wrench(force, hold);
    hold.lag = force.lag;
    hold.max_force = force.max_force;
  }
  message.joints.clear();
  for (const fiber::RodForces::JointForce& force : forces.joints) {
    fiber_proximity::JointForce& joint = message.joints.emplace_back();
    joint.joint = force.joint;
    fill_in_wrench(force, joint);
  }
  message.loads.clear();
  for (const fiber::RodForces::LoadForce& force : forces.loads) {
    fiber_proximity::LoadForce& load = message.loads.emplace_back();
    load.load = force.load;
    fill_in_wrench(force, load);
  }
  const fiber::IslandReport& worst = scene.stepper->report().worst;
  message.residual = worst.residual;
  message.residual_fiber = worst.rod;
  message.residual_node = worst.node;
  message.residual_force = worst.residual_force;
  message.energy_gain = scene.stepper->report().energy_gain;
}

struct Arrow {
  Vector3d at;
  Vector3d force;
  bool is_hold;  // or of a contact
};

/// The next of 1, 2, 5, 10, … that is not below.
double round_up(double value) {
  const double power = std::pow(10.0, std::floor(std::log10(value)));
  for (const double step : {1.0, 2.0, 5.0}) {
    if (value <= step * power) {
      return step * power;
    }
  }
  return 10.0 * power;
}

/// The value that is drawn as full, for the largest value now and the full one before.
double full_scale(double largest, double before) {
  constexpr double min_scale = 1e-9;
  return std::max({largest, fading * before, min_scale});
}

Rgb tension_color(double part) {
  return mix(palette::unloaded, part < 0.0 ? palette::pressed : palette::pulled,
             std::min(1.0, std::abs(part)));
}

std::string newton(double force) {
  std::ostringstream text;
  text << force << " N";
  return text.str();
}

std::vector<Arrow> arrows_of(const fiber::RodForces& forces) {
  std::vector<Arrow> arrows;
  for (const fiber::RodForces::ContactForce& contact : forces.contacts) {
    arrows.push_back({contact.point, contact.normal_force + contact.friction_force, false});
  }
  for (const fiber::RodForces::HoldForce& hold : forces.holds) {
    arrows.push_back({hold.point, hold.force, true});
  }
  const auto is_larger = [](const Arrow& a, const Arrow& b) {
    return a.force.squaredNorm() > b.force.squaredNorm();
  };
  std::stable_sort(arrows.begin(), arrows.end(), is_larger);
  arrows.resize(std::min(arrows.size(), max_arrows));
  return arrows;
}

/// @param full [N] what full red or blue is
void draw_tensions(const fiber::Rods& rods, const std::vector<double>& tensions, double full,
                   MarkerCanvas& canvas) {
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    Marker* line = nullptr;
    for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod); ++i) {
      const double radius = rods.edge_radius(rod, i);
      if (line == nullptr || radius != rods.edge_radius(rod, i - 1)) {
        line = &canvas.add("tensions", Marker::LINE_LIST);
        line->scale.x = 2.2 * radius;
      }
      Marker& marker = *line;
      append_line(rods.positions[i], rods.positions[i + 1],
                  color(tension_color(tensions[i] / full)), marker);
    }
  }
}

/// @param full [N] of the longest arrow
void draw_arrows(const std::vector<Arrow>& arrows, double full, const MarkerScale& scale,
                 MarkerCanvas& canvas) {
  const double thickness = std::max(0.5 * scale.thickest, 0.004 * scale.extent);
  for (const Arrow& arrow : arrows) {
    const Vector3d way = longest_arrow * scale.extent / full * arrow.force;
    if (way.norm() < 0.5 * thickness) {
      continue;  // it would be a dot
    }
    Marker& marker = canvas.add(arrow.is_hold ? "holds" : "contacts", Marker::ARROW);
    marker.scale.x = thickness;
    marker.scale.y = 2.5 * thickness;
    marker.scale.z = std::min(4.0 * thickness, 0.5 * way.norm());
    marker.color = color(arrow.is_hold ? palette::hold_force : palette::contact_force);
    marker.points = {to_message(arrow.at), to_message(arrow.at + way)};
  }
}

}  // namespace

SimForces::SimForces(const ros::NodeHandle& node) : node_(node) {
  forces_ = node_.advertise<fiber_proximity::ForceArray>("forces", 1);
  drawing_ = node_.advertise<visualization_msgs::MarkerArray>("force_markers", 1);
}

ros::Publisher& SimForces::wrench_topic(const fiber::SimScene& scene, const Hold& hold) {
  ros::Publisher& publisher = wrenches_[hold];
  if (!publisher) {
    publisher = node_.advertise<geometry_msgs::WrenchStamped>(
        topic_name(scene, hold.first, hold.second), 1);
  }
  return publisher;
}

void SimForces::advertise_obstacles(const fiber::SimScene& scene) {
  std::vector<std::string> names;
  if (scene.motions() != nullptr) {
    for (const fiber::MovingObstacle& obstacle : scene.motions()->obstacles()) {
      names.push_back(obstacle.object.name);
    }
  }
  if (names == obstacle_names_) {
    return;
  }
  obstacle_names_ = names;
  // Publishers of those that stay are kept until all are advertised, so that listeners are, too.
  std::vector<ros::Publisher> publishers;
  for (std::size_t i = 0; i < names.size(); ++i) {
    publishers.push_back(node_.advertise<geometry_msgs::WrenchStamped>(
        "obstacle_wrenches/" + allowed_name(names, i), 1));
  }
  obstacle_wrenches_ = std::move(publishers);
}

bool SimForces::has_listeners() const {
  const auto is_heard = [](const ros::Publisher& each) { return each.getNumSubscribers() > 0; };
  return std::any_of(obstacle_wrenches_.begin(), obstacle_wrenches_.end(), is_heard) ||
         forces_.getNumSubscribers() > 0 || drawing_.getNumSubscribers() > 0 ||
         std::any_of(wrenches_.begin(), wrenches_.end(),
                     [](const auto& each) { return each.second.getNumSubscribers() > 0; });
}

void SimForces::publish(const fiber::SimScene& scene, const std_msgs::Header& header) {
  // They come and go by ~attach and ~detach; the topic of one that has gone is silent.
  if (scene.attachment != nullptr) {
    for (const Hold& hold : scene.attachment->held_nodes()) {
      wrench_topic(scene, hold);
    }
  }
  advertise_obstacles(scene);
  if (!has_listeners()) {
    return;
  }
  const fiber::RodForces forces = scene.stepper->forces();
  if (forces_.getNumSubscribers() > 0) {
    message_.header = header;
    fill_in(scene, forces, message_);
    forces_.publish(message_);
  }
  for (const fiber::RodForces::HoldForce& hold : forces.holds) {
    wrench_topic(scene, {hold.rod, hold.node}).publish(wrench_of(scene, hold, header));
  }
  for (std::size_t i = 0; i < forces.obstacles.size(); ++i) {
    obstacle_wrenches_[i].publish(wrench_of(forces.obstacles[i], header));
  }
  if (drawing_.getNumSubscribers() > 0) {
    draw(scene, forces, header);
    drawing_.publish(markers_);
  }
}

void SimForces::draw(const fiber::SimScene& scene, const fiber::RodForces& forces,
                     const std_msgs::Header& header) {
  const fiber::Rods& rods = scene.stepper->rods();
  const MarkerScale scale(fiber::assembly_of(rods), header.frame_id);
  double tension = 0.0;
  for (const double each : forces.tensions) {
    tension = std::max(tension, std::abs(each));
  }
  const std::vector<Arrow> arrows = arrows_of(forces);
  max_tension_ = full_scale(tension, max_tension_);
  max_force_ = full_scale(arrows.empty() ? 0.0 : arrows.front().force.norm(), max_force_);
  const double full_tension = round_up(max_tension_);
  const double full_force = round_up(max_force_);
  MarkerCanvas canvas(header, markers_);
  draw_tensions(rods, forces.tensions, full_tension, canvas);
  draw_arrows(arrows, full_force, scale, canvas);
  canvas.add_legend(
      {{palette::pulled, "red: tension, up to " + newton(full_tension)},
       {palette::pressed, "blue: pressure, up to " + newton(full_tension)},
       {palette::contact_force,
        "yellow: contacts; an arrow of full length is " + newton(full_force)},
       {palette::hold_force, "green: holds; an arrow of full length is " + newton(full_force)}},
      scale);
  canvas.finish(drawn_);
}

}  // namespace fiber_proximity_ros
