#pragma once

#include <cstdint>
#include <iosfwd>
#include <set>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_frame.hpp"
#include "fiber_proximity/io/output_file.hpp"

namespace fiber {

/// Reads a fibre file: a header `fiber,x,y,z` with an optional leading `frame` and an optional
/// trailing `radius`, then a row per point [m]. Rows of a frame, and within it rows of a fibre,
/// stand one after another. A fibre's label is any text; its index is its place in the order of
/// appearance. Spaces around values, blank lines and CRLF line ends are allowed. A line has at most
/// 65 536 bytes, a value 4 096.
/// @param default_radius [m] of all fibres if the file has no radius column
/// @throws FileError
/// @throws std::invalid_argument for a bad default_radius
FiberFile read_csv(const std::string& path, double default_radius = 0.0);

/// The same from a stream; errors call it by `name`.
FiberFile read_csv(std::istream& stream, const std::string& name, double default_radius = 0.0);

/// Writes a fibre file frame by frame, so that a long one never is in memory. Fibres are labelled
/// by their index; the radius column is that of the point if there is one per point, else that of
/// its fibre. All numbers read back as the same.
class CsvWriter {
 public:
  /// @param has_frames whether frames have numbers; without them the file holds exactly one
  /// @throws FileError
  CsvWriter(const std::string& path, bool has_frames);

  /// @throws std::invalid_argument for a frame that the file cannot hold: without numbers any but
  ///         the first; with them one without fibres, or with the number of an earlier one
  /// @throws FileError
  void write(const FiberFrame& frame);

  /// Call once, after the last frame: only then is all of it in the file.
  /// @throws FileError
  void finish();

 private:
  const bool has_frames_;
  OutputFile file_;
  std::set<std::int64_t> frames_written_;
  std::string rows_;
};

/// Writes all of a fibre file; see CsvWriter.
void write_csv(const std::string& path, const FiberFile& file);

}  // namespace fiber
