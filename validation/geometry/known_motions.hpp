#pragma once

#include <string>
#include <vector>

#include "validation/geometry/hard_motions.hpp"

namespace fiber {

/// Edges that move, of which somebody else has found out whether they meet.
struct KnownMotion {
  std::string set;
  bool contact = false;
  HardMotion motion;  ///< without thickness
};

/// Reads a file of segment motions (io/segment_file.hpp) whose truth is 0 or 1.
/// @throws FileError as read_segment_motions(), std::runtime_error naming the motion for its truth
std::vector<KnownMotion> read_known_motions(const std::string& path);

/// The 24 numbers of a motion, as in such a file.
std::string coordinates_of(const HardMotion& motion);

}  // namespace fiber
