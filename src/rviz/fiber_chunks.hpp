#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber_proximity_rviz {

/// Consecutive points of one fibre, from the first to the last.
struct Stretch {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

/// Stretches that lie near together: drawn at once, all as finely as the nearest needs.
struct FiberChunk {
  std::vector<Stretch> stretches;
  Eigen::AlignedBox3f box;      ///< [m] of the fibres, as thick as they are, from the origin
  double largest_radius = 0.0;  ///< [m]
  std::size_t segment_count = 0;
};

/// Longer fibres are cut: those from end to end of the scene would be everywhere near.
constexpr std::uint32_t most_stretch_segments = 256;
/// Enough that drawing a chunk takes longer than having it drawn.
constexpr std::size_t most_chunk_segments = std::size_t{1} << 14;

/// All segments, each in one chunk; the same whatever the number of threads.
/// @param origin [m] that boxes count from
std::vector<FiberChunk> make_chunks(const fiber::FiberAssembly& fibers,
                                    const Eigen::Vector3d& origin);

}  // namespace fiber_proximity_rviz
