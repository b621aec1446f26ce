#include "src/environment/obstacle_parts.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace fiber {
namespace {

constexpr double squared_length_tolerance = 0.01;

Eigen::Quaterniond unit_quaternion(const Eigen::Quaterniond& q) {
  if (!(std::abs(q.squaredNorm() - 1.0) <= squared_length_tolerance)) {
    std::ostringstream message;
    message << "orientation (" << q.x() << ", " << q.y() << ", " << q.z() << ", " << q.w()
            << ") has length " << q.norm() << ", it must be a quaternion of length 1";
    throw std::invalid_argument(message.str());
  }
  return q.normalized();
}

void require_dimensions(const std::vector<double>& dimensions, const std::string& type,
                        std::size_t count, const std::string& meaning) {
  if (dimensions.size() != count) {
    throw std::invalid_argument("a " + type + " has " + std::to_string(dimensions.size()) +
                                " dimension(s), it must have " + std::to_string(count) + ": " +
                                meaning);
  }
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

Eigen::Isometry3d make_pose(const Eigen::Vector3d& position,
                            const Eigen::Quaterniond& orientation) {
  if (!position.allFinite()) {
    std::ostringstream text;
    text << "position (" << position.x() << ", " << position.y() << ", " << position.z()
         << ") is not finite";
    throw std::invalid_argument(text.str());
  }
  if (position.isZero(0.0) && orientation.coeffs().isZero(0.0)) {
    return Eigen::Isometry3d::Identity();
  }
  return Eigen::Translation3d(position) * unit_quaternion(orientation);
}

Shape make_primitive(Primitive type, const std::vector<double>& dimensions) {
  switch (type) {
    case Primitive::BOX:
      require_dimensions(dimensions, "box", 3, "x, y and z");
      return BoxShape{{dimensions[0], dimensions[1], dimensions[2]}};
    case Primitive::SPHERE:
      require_dimensions(dimensions, "sphere", 1, "the radius");
      return SphereShape{dimensions[0]};
    case Primitive::CYLINDER:
      require_dimensions(dimensions, "cylinder", 2, "height and radius");
      return CylinderShape{dimensions[1], dimensions[0]};
    default:
      require_dimensions(dimensions, "cone", 2, "height and radius");
      return ConeShape{dimensions[1], dimensions[0]};
  }
}

PlaneShape make_plane(const Eigen::Vector4d& coefficients) {
  const double length = coefficients.head<3>().stableNorm();
  if (!(length > 0.0 && coefficients.allFinite())) {
    std::ostringstream message;
    message << "coef is (" << coefficients[0] << ", " << coefficients[1] << ", " << coefficients[2]
            << ", " << coefficients[3]
            << "), it must be finite and its first three not all 0: ax + by + cz + d = 0";
    throw std::invalid_argument(message.str());
  }
  return {coefficients.head<3>() / length, -coefficients[3] / length};
}

HalfSpaceShape make_half_space(const Eigen::Vector4d& coefficients) {
  const PlaneShape boundary = make_plane(coefficients);
  return {boundary.normal, boundary.offset};
}

}  // namespace fiber
