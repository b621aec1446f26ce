#pragma once

#include <std_msgs/Header.h>

#include <Eigen/Core>
#include <cstdint>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_ros {

/// Fibres on their way into an assembly: what every type of message is read into and what the
/// inputs are merged in. Flat as FiberAssembly, but not validated. Kept and reused by its owner.
struct FiberBuffer {
  std_msgs::Header header;
  std::vector<Eigen::Vector3d> points;    ///< [m] in header.frame_id
  std::vector<std::uint32_t> offsets{0};  ///< as FiberAssembly
  std::vector<double> radii;       ///< [m] as FiberAssembly; empty where the message has none
  std::vector<std::string> names;  ///< one per fibre; empty where the message has none

  void clear();

  /// Ends the fibre that the points since the previous call make.
  void end_chain() { offsets.push_back(static_cast<std::uint32_t>(points.size())); }

  std::size_t fiber_count() const { return offsets.empty() ? 0 : offsets.size() - 1; }
};

/// Makes the assembly that of the chains, without allocating where only the points differ.
/// @throws std::invalid_argument as FiberAssembly; the assembly is unchanged then
void assign(const FiberBuffer& chains, fiber::FiberAssembly& fibers);

}  // namespace fiber_proximity_ros
