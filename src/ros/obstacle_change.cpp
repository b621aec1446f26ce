#include "fiber_proximity/ros/obstacle_change.hpp"

#include <stdexcept>
#include <vector>

#include "fiber_proximity/ros/naming.hpp"
#include "fiber_proximity/ros/obstacle_pose.hpp"
#include "fiber_proximity/ros/obstacle_shapes.hpp"
#include "fiber_proximity/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

using fiber_proximity::Obstacle;
using Poses = std::vector<geometry_msgs::Pose>;

using Operation = fiber::ObjectChange::Operation;

Operation to_operation(const Obstacle& obstacle) {
  switch (obstacle.operation) {
    case Obstacle::ADD:
      return Operation::ADD;
    case Obstacle::REMOVE:
      return Operation::REMOVE;
    case Obstacle::APPEND:
      return Operation::APPEND;
    case Obstacle::MOVE:
      return Operation::MOVE;
    default:
      throw std::invalid_argument("operation is " + std::to_string(obstacle.operation) +
                                  ", it must be 0 (ADD), 1 (REMOVE), 2 (APPEND) or 3 (MOVE)");
  }
}

/// Appends the shapes of one list of the message.
template <class Shapes, class ToShape>
void append(const std::string& kind, const Shapes& shapes, const Poses& poses,
            const ToShape& convert, std::vector<fiber::PlacedShape>& placed) {
  if (!poses.empty() && poses.size() != shapes.size()) {
    throw std::invalid_argument(std::to_string(poses.size()) + " pose(s) of " +
                                std::to_string(shapes.size()) + " " + kind +
                                "(s); give one for each or none");
  }
  for (std::size_t i = 0; i < shapes.size(); ++i) {
    placed.push_back(naming(kind + " " + std::to_string(i), [&] {
      fiber::PlacedShape shape;
      shape.shape = convert(shapes[i]);
      if (!poses.empty()) {
        shape.pose = to_pose(poses[i]);
      }
      return shape;
    }));
  }
}

fiber::ObjectChange to_unnamed_change(const Obstacle& obstacle) {
  fiber::ObjectChange change;
  change.operation = to_operation(obstacle);
  if (!obstacle.id.empty() || change.operation != fiber::ObjectChange::Operation::REMOVE) {
    validate_obstacle_name(obstacle.id);
  }
  change.object.name = obstacle.id;
  change.object.pose = naming("pose", [&] { return to_pose(obstacle.pose); });
  std::vector<fiber::PlacedShape>& shapes = change.object.shapes;
  const auto convert = [](const auto& shape) { return to_shape(shape); };
  append("primitive", obstacle.primitives, obstacle.primitive_poses, convert, shapes);
  append("capsule", obstacle.capsules, obstacle.capsule_poses, convert, shapes);
  append("mesh", obstacle.meshes, obstacle.mesh_poses, convert, shapes);
  append("plane", obstacle.planes, obstacle.plane_poses, to_plane, shapes);
  append("half-space", obstacle.half_spaces, obstacle.half_space_poses, to_half_space, shapes);
  return change;
}

}  // namespace

void validate_obstacle_name(const std::string& name) {
  if (name.empty()) {
    throw std::invalid_argument("id is empty, it must name the object");
  }
  if (name == cloud_name || name.rfind(robot_prefix, 0) == 0) {
    throw std::invalid_argument("'" + cloud_name + "' and names that begin with '" + robot_prefix +
                                "' are those of the point cloud and the links of the robot");
  }
}

fiber::ObjectChange to_change(const Obstacle& obstacle) {
  fiber::ObjectChange change =
      naming("obstacle " + fiber::quote(obstacle.id), [&] { return to_unnamed_change(obstacle); });
  if (!change.object.name.empty()) {
    fiber::validate(change.object);
  }
  return change;
}

}  // namespace fiber_proximity_ros
