#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>

#include <Eigen/Geometry>
#include <cstdint>
#include <string>
#include <vector>

#include "fiber_proximity/Contact.h"
#include "fiber_proximity/Crossing.h"
#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/query/crossings.hpp"
#include "fiber_proximity/ros/fiber_buffer.hpp"

namespace fiber_proximity_ros {

template <class Point>
Eigen::Vector3d to_vector(const Point& point) {
  return {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)};
}

geometry_msgs::Point to_message(const Eigen::Vector3d& point);
geometry_msgs::Vector3 to_vector_message(const Eigen::Vector3d& vector);
geometry_msgs::Pose to_message(const Eigen::Isometry3d& pose);

/// Everything but the header. Memory of the message is reused.
/// @param names one per fibre, or none
void to_message(const fiber::FiberAssembly& fibers, const std::vector<std::string>& names,
                fiber_proximity::FiberArray& message);

/// @param body_a, body_b what the bodies are, as the message has it
void to_message(const fiber::Contact& contact, std::uint8_t body_a, std::uint8_t body_b,
                fiber_proximity::Contact& message);

/// Adds the derivatives of a contact's distance, see fiber::gradient_of().
void add_gradients(fiber_proximity::Contact& message);

void to_message(const fiber::Crossing& crossing, fiber_proximity::Crossing& message);

/// @throws std::invalid_argument if there are names, but not one per fibre
void to_chains(const fiber_proximity::FiberArray& message, FiberBuffer& chains);

}  // namespace fiber_proximity_ros
