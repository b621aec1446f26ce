#pragma once

#include <optional>
#include <string>

#include "fiber_proximity/io/csv.hpp"
#include "fiber_proximity/io/fiber_frame.hpp"
#include "fiber_proximity/io/pvd.hpp"

namespace fiber {

// The name decides the format: one that ends in .hair, in capitals or not, is a HAIR file (see
// hair_file.hpp), one that is written and ends in .pvd is for ParaView (see pvd.hpp), every other
// one CSV (see csv.hpp).

/// Reads a fibre file of either format.
/// @param default_radius [m] of all fibres if the file has no radii
/// @throws FileError
/// @throws std::invalid_argument for a bad default_radius
FiberFile read_fibers(const std::string& path, double default_radius = 0.0);

/// Writes a fibre file of any format frame by frame.
class FiberWriter {
 public:
  /// @param has_frames whether frames have numbers, which a HAIR file cannot hold; without them the
  ///        file holds exactly one
  /// @throws FileError
  FiberWriter(const std::string& path, bool has_frames);

  /// @param time of the frame [s], which only .pvd files hold; none: the frame's number
  /// @throws std::invalid_argument for a frame that the file cannot hold; see CsvWriter, write_hair
  /// @throws FileError
  void write(const FiberFrame& frame, std::optional<double> time = std::nullopt);

  /// Call once, after the last frame: only then is all of it in the file.
  /// @throws FileError
  void finish();

 private:
  const std::string path_;
  const bool has_frames_;
  bool wrote_hair_ = false;
  std::optional<CsvWriter> csv_;
  std::optional<PvdWriter> pvd_;  // neither for a HAIR file
};

/// Writes all of a fibre file; see FiberWriter.
void write_fibers(const std::string& path, const FiberFile& file);

}  // namespace fiber
