#pragma once

#include <Eigen/Core>
#include <iosfwd>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/io/file.hpp"

namespace fiber {

/// Two segments [m].
struct SegmentPair {
  std::string name;        ///< "" for none
  Eigen::Vector3d p0, p1;  ///< ends of the first
  Eigen::Vector3d q0, q1;  ///< ends of the second
};

/// Reads a file of pairs of segments, one a line: the 12 coordinates of p0, p1, q0 and q1 [m],
/// decimal or C hexadecimal, separated by commas, semicolons, blanks or one of these and blanks. A
/// name may stand before them that is no number, or any one where the header begins with `name`;
/// further columns are ignored, and so are blank
/// lines, lines that begin with # and a first line of column names. Quotes, and how long lines and
/// values may be, are as in read_csv().
/// @throws FileError naming line, column, value and what is allowed
FIBER_PROXIMITY_EXPORT std::vector<SegmentPair> read_segment_pairs(const std::string& path);

/// Reads them from a stream; errors call it by `name`.
FIBER_PROXIMITY_EXPORT std::vector<SegmentPair> read_segment_pairs(std::istream& stream,
                                                                   const std::string& name);

/// Two segments whose ends each move linearly, from where they are before, at t = 0, to where they
/// are after, at t = 1 [m].
struct MovingSegmentPair {
  std::string set;    ///< what it is one of
  std::string truth;  ///< whether they meet, as somebody knows it
  Eigen::Vector3d a_before[2];
  Eigen::Vector3d b_before[2];
  Eigen::Vector3d a_after[2];
  Eigen::Vector3d b_after[2];
};

/// Reads a file of pairs of segments that move, one a line: the name of a set, the truth as
/// somebody knows it, and the 24 coordinates of a0, a1, b0 and b1 at t = 0, then of the same at t =
/// 1 [m], decimal or C hexadecimal. Set and truth may be any text, also none.
/// Separators, blank lines and a first line of column names are as in read_segment_pairs(); further
/// columns are refused.
/// @throws FileError naming line, column, value and what is allowed
FIBER_PROXIMITY_EXPORT std::vector<MovingSegmentPair> read_segment_motions(const std::string& path);

/// Reads them from a stream; errors call it by `name`.
FIBER_PROXIMITY_EXPORT std::vector<MovingSegmentPair> read_segment_motions(std::istream& stream,
                                                                           const std::string& name);

}  // namespace fiber
