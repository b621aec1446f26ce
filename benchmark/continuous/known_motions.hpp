#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/scenes/hard_motions.hpp"

namespace fiber::bench {

/// Edges that move, of which somebody else has found out whether they meet.
struct KnownMotion {
  std::string set;
  bool contact = false;
  HardMotion motion;  ///< without thickness
};

/// Reads a file of lines `set,truth` and 24 numbers in hexadecimal: the ends of a and those of b,
/// before and then after.
/// @throws std::runtime_error that names file and line
std::vector<KnownMotion> read_known_motions(const std::string& path);

/// The 24 numbers of a motion, as in such a file.
std::string coordinates_of(const HardMotion& motion);

}  // namespace fiber::bench
