#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Options of every scene.
struct SceneOptions {
  double scale = 1.0;      ///< of the number of fibres; above 0. At least one fibre remains.
  std::uint64_t seed = 1;  ///< of all that is random
  bool shuffle = false;    ///< put the fibres into random order
};

/// A scene gives its fibres at any frame; the topology is the same at all of them.
using Scene = std::function<FiberAssembly(std::uint32_t frame)>;

/// The scene of this name (see scene_names()).
/// @throws std::invalid_argument listing the names; options are judged when a frame is asked for
Scene make_scene(const std::string& name, const SceneOptions& options);

/// Names of all scenes.
std::vector<std::string> scene_names();

/// A scene of any size, of which any fibres can be made without the others: each has random numbers
/// of its own. The more there are, the more room they take, so that contacts per segment stay what
/// they are. All fibres are of a hair's radius and have the same number of segments.
struct LargeScene {
  /// Most segments that may be asked for.
  static constexpr std::uint64_t max_segments = 1'000'000'000'000'000;

  std::uint64_t fiber_count = 0;  ///< as many as it takes to have the segments asked for
  std::uint32_t segments_per_fiber = 0;
  int dimensions = 3;  ///< in which it grows: 3 for a cube, 2 for what is side by side

  /// So many segments that are beside each other look like any larger part of the scene: those of
  /// hair are as wide as it is long.
  std::uint64_t typical_segments = 1;

  /// Fibres begin … end - 1 at a frame, the same bits everywhere.
  /// @throws std::invalid_argument for fibres that there are not, and for more points than an
  ///         assembly may have
  std::function<FiberAssembly(std::uint64_t begin, std::uint64_t end, std::uint32_t frame)> fibers;

  std::uint64_t segment_count() const { return fiber_count * segments_per_fiber; }
};

/// The scene of this name.
///
/// `soup`:    the fibres of the scene of the same name, 100 segments each; 10⁶ segments to a cubic
///            metre, in a cube.
/// `tress_b`: tresses of 500 long curls of 2 000 segments each, 3 cm apart in a square, so that
///            neighbours mingle. The last one may have fewer hairs.
/// `locks`:   a groom of hairs of 64 segments that hang from a square, 200 per cm², in locks of 40.
///
/// At seed 1, frame 0 and margin 0, neighbours in a fibre left out, there are 0.006, 0.12 and 0.23
/// contacts per segment.
/// @param segments at least, in whole fibres
/// @param seed     of all that is random
/// @throws std::invalid_argument listing the names, and for a number of segments that is 0 or above
///         max_segments
LargeScene make_large_scene(const std::string& name, std::uint64_t segments,
                            std::uint64_t seed = 1);

/// Names of all large scenes.
std::vector<std::string> large_scene_names();

}  // namespace fiber
