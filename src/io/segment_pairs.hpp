#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <vector>

#include "fiber_proximity/io/file_error.hpp"

namespace fiber {

/// Two segments [m].
struct SegmentPair {
  Eigen::Vector3d p0, p1;  ///< ends of the first
  Eigen::Vector3d q0, q1;  ///< ends of the second
};

/// Reads a file of pairs of segments, one a line: the 12 coordinates of p0, p1, q0 and q1 [m],
/// decimal or C hexadecimal, separated by commas, blanks or both. A name that is no number may
/// stand before them; further columns are ignored, and so are blank lines and a first line of
/// column names. Lines and values are at most as long as in csv.hpp.
/// @throws FileError naming line, column, value and what is allowed
std::vector<SegmentPair> read_segment_pairs(const std::string& path);

/// The same from a stream; errors call it by `name`.
std::vector<SegmentPair> read_segment_pairs(std::istream& stream, const std::string& name);

}  // namespace fiber
