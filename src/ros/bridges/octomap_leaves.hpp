#pragma once

#include <octomap_msgs/Octomap.h>

#include <array>
#include <cstdint>
#include <vector>

namespace fiber_proximity_ros {

/// A cube of cells. Cell (i, j, k) reaches from there to (i + 1, j + 1, k + 1), times the
/// resolution.
struct OctomapLeaf {
  std::array<std::int32_t, 3> first{};  ///< the cell with the least indices
  std::int32_t cells = 1;               ///< along an edge, a power of two
};

/// The leaves that octomap takes for occupied, in the order of the octree; those that were pruned
/// are larger than a cell. Reads OcTree, ColorOcTree and OcTreeStamped, binary or full. octomap's
/// own readers cannot be used, as they trust what they read: data that nest too deeply overflow the
/// stack, and what is missing where data end is made up.
/// @throws std::invalid_argument for another type of octree, a resolution or data that are none
std::vector<OctomapLeaf> read_occupied_leaves(const octomap_msgs::Octomap& map);

}  // namespace fiber_proximity_ros
