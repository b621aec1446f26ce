#pragma once

#include <string>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/geometry/fiber_graph.hpp"

namespace fiber {

/// Names a part that is closed or joined, "" if there is none: ranks do not know of joints, and
/// their files do not hold them.
inline std::string error_of_joints(const FiberAssembly& parts) {
  if (parts.graph() == nullptr) {
    return "";
  }
  const FiberGraph::JointPoint& first = parts.graph()->joint_points().front();
  return "part " + std::to_string(first.fiber) + ", point " +
         std::to_string(first.point - parts.offsets()[first.fiber]) +
         (parts.is_closed(first.fiber) ? ": the fibre is closed" : ": the point is joined") +
         "; the ranks of MPI take open fibres that are not joined, an engine of one process takes "
         "all";
}

}  // namespace fiber
