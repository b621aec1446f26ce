#pragma once

#include <Eigen/Geometry>
#include <cstddef>
#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/rviz/fiber_mesh.hpp"

namespace fiber_proximity_rviz {

/// Consecutive points of one fibre, from the first to the last.
struct PointRange {
  std::uint32_t first = 0;
  std::uint32_t last = 0;
};

/// Ranges that lie near together. They are drawn at once, all as finely as the nearest needs.
struct FiberChunk {
  std::vector<PointRange> ranges;
  Eigen::AlignedBox3f box;      ///< [m] of the fibres, as thick as they are, from the origin
  double largest_radius = 0.0;  ///< [m]
  std::size_t segment_count = 0;
};

/// Longer fibres are cut: those from end to end of the scene would be everywhere near.
constexpr std::uint32_t max_range_segments = 256;
/// Enough that drawing a chunk takes longer than having it drawn.
constexpr std::size_t max_chunk_segments = std::size_t{1} << 14;

/// All segments, each in one chunk; the same whatever the number of threads.
/// @param origin [m] that boxes count from
std::vector<FiberChunk> make_chunks(const fiber::FiberAssembly& fibers,
                                    const Eigen::Vector3d& origin);

/// The level of detail that the user asks for.
struct DetailOptions {
  bool is_reduced = true;    ///< else all points are drawn
  float pixel_error = 0.5F;  ///< [pixels] that a fibre may be drawn beside where it is; above 0
};

/// The level of detail at which a chunk is drawn.
struct Detail {
  enum class Kind { ribbons, lines };

  Kind kind = Kind::ribbons;
  int level = finest;  ///< the tolerance's power of two

  static constexpr int finest = -60;  ///< all points

  /// [m] that what is drawn may be beside what is there: 2 to the power of the level, 0 of the
  /// finest.
  double tolerance() const;

  bool operator<(const Detail& other) const {
    return kind != other.kind ? kind < other.kind : level < other.level;
  }
};

/// Lines, which are a pixel wide, where no fibre of the chunk is wider; the coarsest level whose
/// tolerance is within the pixel error. Levels differ by a factor of two, so that few are needed
/// while the view comes nearer.
/// @param pixel [m] at the nearest of the chunk, above 0
Detail choose_detail(const FiberChunk& chunk, double pixel, const DetailOptions& options);

/// Points that a range is drawn through: its ends, and of those between as few as a quick search
/// finds. What is left out is within the tolerance of the line that is drawn, and has the colour
/// and the width of its ends.
/// @param points    [m] of the fibres
/// @param vertices  two per point, those of FiberMesher::make_ribbons()
/// @param tolerance [m] at least 0; at 0 all points are kept
/// @param kept      gets them in order, after what it has
void simplify(const std::vector<Eigen::Vector3d>& points, const std::vector<MeshVertex>& vertices,
              const PointRange& range, double tolerance, std::vector<std::uint32_t>& kept);

/// The indices of the vertices that are drawn: three per triangle of ribbons, two per line.
std::vector<std::uint32_t> make_indices(const std::vector<Eigen::Vector3d>& points,
                                        const std::vector<MeshVertex>& vertices,
                                        const FiberChunk& chunk, const Detail& detail);

}  // namespace fiber_proximity_rviz
