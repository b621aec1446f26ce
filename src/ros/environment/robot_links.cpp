#include "src/ros/environment/robot_links.hpp"

#include <urdf/model.h>

#include <sstream>
#include <stdexcept>
#include <utility>

#include "src/environment/obstacle_parts.hpp"
#include "src/ros/environment/obstacle_change.hpp"
#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

Eigen::Isometry3d to_isometry(const urdf::Pose& pose) {
  const Eigen::Quaterniond rotation(pose.rotation.w, pose.rotation.x, pose.rotation.y,
                                    pose.rotation.z);
  return Eigen::Translation3d(pose.position.x, pose.position.y, pose.position.z) *
         rotation.normalized();
}

Eigen::Vector3d to_eigen(const urdf::Vector3& vector) { return {vector.x, vector.y, vector.z}; }

fiber::Shape shape_of(const urdf::Geometry& geometry, const MeshLoader& meshes) {
  switch (geometry.type) {
    case urdf::Geometry::BOX:
      return fiber::BoxShape{to_eigen(dynamic_cast<const urdf::Box&>(geometry).dim)};
    case urdf::Geometry::SPHERE:
      return fiber::SphereShape{dynamic_cast<const urdf::Sphere&>(geometry).radius};
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(geometry);
      return fiber::CylinderShape{cylinder.radius, cylinder.length};
    }
    case urdf::Geometry::MESH: {
      const auto& mesh = dynamic_cast<const urdf::Mesh&>(geometry);
      return meshes(mesh.filename, to_eigen(mesh.scale));
    }
    default:
      throw std::invalid_argument("its geometry must be a box, sphere, cylinder or mesh");
  }
}

fiber::PlacedShape to_placed_shape(const urdf::Collision& collision, const MeshLoader& meshes) {
  if (collision.geometry == nullptr) {
    throw std::invalid_argument("it has no geometry");
  }
  return {shape_of(*collision.geometry, meshes), to_isometry(collision.origin)};
}

RobotLink read_link(const urdf::Link& link, const MeshLoader& meshes) {
  RobotLink read;
  read.frame = link.name;
  read.object.name = fiber::robot_prefix + link.name;
  for (std::size_t i = 0; i < link.collision_array.size(); ++i) {
    fiber::with_context("link '" + link.name + "', collision " + std::to_string(i), [&] {
      read.object.shapes.push_back(to_placed_shape(*link.collision_array[i], meshes));
    });
  }
  fiber::validate(read.object);
  return read;
}

urdf::Model read_model(const std::string& description) {
  urdf::Model model;
  if (!model.initString(description)) {
    throw std::invalid_argument("the robot's description is no URDF of a robot (see the log)");
  }
  return model;
}

/// A link that must be there and have collision geometry.
RobotLink read_link_of(const std::string& description, const std::string& name,
                       const MeshLoader& meshes) {
  const urdf::Model model = read_model(description);
  const auto found = model.links_.find(name);
  if (found == model.links_.end()) {
    std::vector<std::string> names;
    for (const auto& [known, link] : model.links_) {
      names.push_back(known);
    }
    throw std::invalid_argument(
        "the robot " + fiber::quote(model.getName()) +
        " has no such link, it has: " + fiber::shortened(fiber::join(names)));
  }
  if (found->second->collision_array.empty()) {
    throw std::invalid_argument("this link of the robot " + fiber::quote(model.getName()) +
                                " has no collision geometry, it needs some");
  }
  return read_link(*found->second, meshes);
}

using Operation = fiber::ObjectChange::Operation;

}  // namespace

std::vector<RobotLink> read_robot(const std::string& description, const MeshLoader& meshes) {
  const urdf::Model model = read_model(description);
  std::vector<RobotLink> links;
  for (const auto& [name, link] : model.links_) {
    if (!link->collision_array.empty()) {
      links.push_back(read_link(*link, meshes));
    }
  }
  if (links.empty()) {
    throw std::invalid_argument("the robot '" + model.getName() +
                                "' has no collision geometry, it needs that of 1 link at least");
  }
  return links;
}

std::string robot_description(const ros::NodeHandle& node, const std::string& parameter) {
  try {
    std::string description;
    if (!node.getParam(parameter, description)) {
      throw std::invalid_argument("parameter " + node.resolveName(parameter) +
                                  " is not set, it must be the URDF of the robot");
    }
    return description;
  } catch (const ros::InvalidNameException& error) {
    throw std::invalid_argument(fiber::quote(parameter) +
                                " is not the name of a parameter: " + error.what());
  }
}

fiber::LinkSource robot_links(const ros::NodeHandle& node, const MeshLoader& meshes) {
  return [node, meshes](const std::string& link, const std::string& named) {
    const std::string parameter = named.empty() ? "robot_description" : named;
    const std::string description = robot_description(node, parameter);
    return fiber::with_context("parameter " + node.resolveName(parameter), [&] {
      return read_link_of(description, link, meshes).object.shapes;
    });
  };
}

RobotLinks::RobotLinks(const std::vector<RobotLink>& links, double timeout) : timeout_(timeout) {
  for (const RobotLink& link : links) {
    links_.emplace_back(link);
  }
}

bool RobotLinks::update(const ros::Time& stamp, const FindPose& find_pose, fiber::World& world,
                        ObjectTracks& tracks) {
  std::vector<fiber::ObjectChange> changes;
  for (Link& link : links_) {
    const std::optional<FramePose> found = this->find_pose(link, stamp, find_pose);
    if (auto change = place(link, found)) {
      changes.push_back(std::move(*change));
    }
    if (found && !found->stamp.isZero()) {
      tracks.observe(link.object.name, found->pose, found->stamp);
    } else {
      tracks.forget(link.object.name);
    }
  }
  world.apply(changes);
  return !changes.empty();
}

std::vector<Unknown> RobotLinks::unknown() const {
  std::vector<Unknown> unknown;
  for (const Link& link : links_) {
    if (!link.is_present) {
      unknown.push_back({"robot", link.object.name, link.known, link.error});
    }
  }
  return unknown;
}

std::optional<fiber::ObjectChange> RobotLinks::place(Link& link,
                                                     const std::optional<FramePose>& found) {
  const bool was_present = std::exchange(link.is_present, found.has_value());
  if (!found) {
    return was_present ? std::make_optional(removal_of(link.object.name)) : std::nullopt;
  }
  if (was_present && found->pose.matrix() == link.object.pose.matrix()) {
    return std::nullopt;
  }
  link.object.pose = found->pose;
  fiber::ObjectChange change{was_present ? Operation::MOVE : Operation::ADD,
                             {link.object.name, found->pose, {}}};
  if (!was_present) {
    change.object.shapes = link.object.shapes;
  }
  return change;
}

std::optional<FramePose> RobotLinks::find_pose(Link& link, const ros::Time& stamp,
                                               const FindPose& find_pose) const {
  if (link.known.isZero()) {
    link.known = stamp;
  }
  try {
    const FramePose found = find_pose(link.frame, stamp);
    fiber::validate(found.pose);
    const double age = found.stamp.isZero() ? 0.0 : (stamp - found.stamp).toSec();
    if (age <= timeout_) {
      link.known = found.stamp.isZero() ? stamp : found.stamp;
      return found;
    }
    std::ostringstream message;
    message << "its transform is of " << found.stamp << ", older than " << timeout_
            << " s (robot_timeout)";
    link.error = message.str();
  } catch (const TransformUnavailable& error) {
    link.error = error.what();
  } catch (const std::invalid_argument& error) {
    link.error = error.what();
  }
  return std::nullopt;
}

}  // namespace fiber_proximity_ros
