#include "fiber_proximity/ros/obstacle_pose.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {
namespace {

constexpr double unit_tolerance = 0.01;

Eigen::Quaterniond to_rotation(const geometry_msgs::Quaternion& q) {
  const Eigen::Quaterniond rotation(q.w, q.x, q.y, q.z);
  if (!(std::abs(rotation.squaredNorm() - 1.0) <= unit_tolerance)) {
    std::ostringstream message;
    message << "orientation (" << q.x << ", " << q.y << ", " << q.z << ", " << q.w
            << ") has length " << rotation.norm() << ", it must be a quaternion of length 1";
    throw std::invalid_argument(message.str());
  }
  return rotation.normalized();
}

}  // namespace

Eigen::Isometry3d to_pose(const geometry_msgs::Pose& message) {
  const Eigen::Vector3d position = to_vector(message.position);
  const geometry_msgs::Quaternion& q = message.orientation;
  if (!position.allFinite()) {
    std::ostringstream text;
    text << "position (" << position.x() << ", " << position.y() << ", " << position.z()
         << ") is not finite";
    throw std::invalid_argument(text.str());
  }
  if (position.isZero(0.0) && q.x == 0.0 && q.y == 0.0 && q.z == 0.0 && q.w == 0.0) {
    return Eigen::Isometry3d::Identity();
  }
  return Eigen::Translation3d(position) * to_rotation(q);
}

}  // namespace fiber_proximity_ros
