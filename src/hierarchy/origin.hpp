#pragma once

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// The origin that a hierarchy of these fibres is relative to [m]: the first point, near all others
/// in any scene single precision can serve, and the same for the same input.
inline Eigen::Vector3d hierarchy_origin(const FiberAssembly& fibers) {
  return fibers.points().empty() ? Eigen::Vector3d::Zero() : fibers.points().front();
}

}  // namespace fiber
