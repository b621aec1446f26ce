#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"

namespace fiber {

/// Fibres in the memory of the host, as a tree on a device takes them.
struct HostFibers {
  const double* coordinates = nullptr;  ///< three per point [m]
  std::size_t point_count = 0;
  /// By first point; none where all have the one [m].
  const double* radii = nullptr;
  double radius = 0.0;    ///< [m]
  double origin[3] = {};  ///< [m] that the tree is relative to
  /// By candidate, and of what stands still; none where there are no candidates.
  const std::vector<std::uint32_t>* candidate_points = nullptr;
};

/// Throws what names the first point that fibres may not have, and its candidate.
/// @throws std::invalid_argument
[[noreturn]] FIBER_PROXIMITY_EXPORT void refuse_points(const HostFibers& fibers);

}  // namespace fiber
