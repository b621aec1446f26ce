#pragma once

#include <Eigen/Core>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// What a tree is fitted to: fibres where they are, or with each point moving linearly from there
/// to where it is after. All is relative to an origin [m], which may move as well: what moves along
/// with it stands still.
struct TreeFibers {
  TreeFibers(const FiberAssembly& fibers, const Eigen::Vector3d& origin)
      : before(fibers), after(fibers), origin_before(origin), origin_after(origin) {}
  TreeFibers(const FiberAssembly& from, const FiberAssembly& to, const Eigen::Vector3d& origin_from,
             const Eigen::Vector3d& origin_to)
      : before(from), after(to), origin_before(origin_from), origin_after(origin_to), moves(true) {}

  const FiberAssembly& before;
  const FiberAssembly& after;
  Eigen::Vector3d origin_before;
  Eigen::Vector3d origin_after;
  bool moves = false;
};

}  // namespace fiber
