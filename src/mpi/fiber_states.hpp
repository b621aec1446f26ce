#pragma once

#include <algorithm>
#include <cstdint>

#include "src/mpi/box_tree.hpp"
#include "src/mpi/named_fibers.hpp"

namespace fiber {

/// Fibres as they are, or before and after a motion, of the same runs and points then.
struct FiberStates {
  const NamedFibers& before;
  const NamedFibers* after = nullptr;  // none: they stay

  /// Around segments that follow each other, on all their way.
  /// @param begin, end the first point and the last one
  PlainBox box_around(std::uint64_t begin, std::uint64_t end) const {
    const Eigen::Vector3d& first = before.fibers().points()[begin];
    Eigen::Array3d lower = first;
    Eigen::Array3d upper = first;
    double radius = 0.0;
    for (const NamedFibers* const state : {&before, after}) {
      if (state == nullptr) {
        continue;
      }
      const FiberAssembly& fibers = state->fibers();
      for (std::uint64_t p = begin; p <= end; ++p) {
        lower = lower.min(fibers.points()[p].array());
        upper = upper.max(fibers.points()[p].array());
      }
      for (std::uint64_t p = begin; p < end; ++p) {
        radius = std::max(radius, fibers.segment_radius(static_cast<std::uint32_t>(p)));
      }
    }
    return inflated({{lower[0], lower[1], lower[2]}, {upper[0], upper[1], upper[2]}}, radius);
  }
};

}  // namespace fiber
