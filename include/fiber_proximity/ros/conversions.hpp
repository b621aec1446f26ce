#pragma once

#include <geometry_msgs/Point.h>
#include <geometry_msgs/Pose.h>
#include <geometry_msgs/Vector3.h>
#include <std_msgs/Header.h>

#include <Eigen/Core>
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

namespace fiber_proximity_ros {

/// Fibres that have been read from messages of any type and are not validated yet. The layout is
/// that of fiber::FiberAssembly. The memory is reused by the next message.
struct FiberBuffer {
  std_msgs::Header header;
  std::vector<Eigen::Vector3d> points;    ///< [m] in header.frame_id
  std::vector<std::uint32_t> offsets{0};  ///< of each fibre's first point, and the number of points
  std::vector<double>
      radii;  ///< [m] one, one per fibre or one per point; empty where there are none
  std::vector<std::string> names;  ///< one per fibre; empty where the message has none
  fiber::FiberTopology topology;   ///< which fibres are closed, and what is joined

  void clear();

  /// Ends the fibre that the points since the previous call make.
  void end_chain() { offsets.push_back(static_cast<std::uint32_t>(points.size())); }

  std::size_t fiber_count() const { return offsets.empty() ? 0 : offsets.size() - 1; }

  bool has_radius_per_point() const { return radii.size() > 1 && radii.size() == points.size(); }

  /// @param fiber below fiber_count(), where `closed` has a value for each or none
  bool is_closed(std::size_t fiber) const {
    return !topology.closed.empty() && topology.closed[fiber] != 0;
  }
};

/// Makes the assembly that of the buffer's fibres without copying their points, and without
/// allocating where only the points differ. The buffer keeps header and names; the rest of it is
/// unspecified then.
/// @throws std::invalid_argument as FiberAssembly; the assembly is unchanged then
void assign(FiberBuffer& buffer, fiber::FiberAssembly& fibers);

/// The vector of a message with the members x, y and z.
template <class Point>
Eigen::Vector3d to_vector(const Point& point) {
  return {static_cast<double>(point.x), static_cast<double>(point.y), static_cast<double>(point.z)};
}

/// Messages of a point, a vector and a pose.
geometry_msgs::Point to_message(const Eigen::Vector3d& point);
geometry_msgs::Vector3 to_vector_message(const Eigen::Vector3d& vector);
geometry_msgs::Pose to_message(const Eigen::Isometry3d& pose);

/// Writes fibres into a message, all but the header. Memory of the message is reused.
/// @param names one per fibre, or none
void to_message(const fiber::FiberAssembly& fibers, const std::vector<std::string>& names,
                fiber_proximity::FiberArray& message);

/// Writes a contact into a message.
/// @param body_a, body_b types of the bodies, constants of fiber_proximity::Contact such as FIBER
void to_message(const fiber::Contact& contact, std::uint8_t body_a, std::uint8_t body_b,
                fiber_proximity::Contact& message);

/// Adds the derivatives of a contact's distance, see fiber::gradient_of().
void add_gradients(fiber_proximity::Contact& message);

/// Writes a crossing into a message.
void to_message(const fiber::Crossing& crossing, fiber_proximity::Crossing& message);

/// @throws std::invalid_argument if there are names, but not one per fibre
void to_chains(const fiber_proximity::FiberArray& message, FiberBuffer& fibers);

}  // namespace fiber_proximity_ros
