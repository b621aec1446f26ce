#pragma once

#include <cstddef>
#include <cstdint>
#include <iosfwd>
#include <memory>
#include <optional>
#include <ostream>
#include <set>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/io/file.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Names of fibres, by index. Fibres without names of their own are called by their indices,
/// which takes no memory. Copies share the names.
class FiberNames {
 public:
  static constexpr std::size_t longest_name = 4'096;  ///< [byte]

  FiberNames() = default;

  /// @param names one per fibre, each another one, any text of one line; 0, 1, 2, … in this order
  ///              are the indices
  /// @throws std::invalid_argument for a name that is empty, longer than longest_name, of several
  ///         lines or given twice
  explicit FiberNames(std::vector<std::string> names);

  bool are_indices() const { return names_ == nullptr; }

  /// How many there are; 0 if they are indices, of which there are as many as fibres.
  std::size_t size() const { return names_ == nullptr ? 0 : names_->size(); }

  /// The name of a fibre.
  /// @param fiber below size(), unless names are indices
  std::string of(std::uint64_t fiber) const {
    return names_ == nullptr ? std::to_string(fiber) : (*names_)[fiber];
  }

  /// All of them.
  std::vector<std::string> list(std::size_t fiber_count) const;

  /// Those of some fibres, in this order.
  FiberNames select(const std::vector<std::uint32_t>& fibers) const;

  bool operator==(const FiberNames& other) const {
    return names_ == other.names_ ||
           (names_ != nullptr && other.names_ != nullptr && *names_ == *other.names_);
  }
  bool operator!=(const FiberNames& other) const { return !(*this == other); }

 private:
  std::shared_ptr<const std::vector<std::string>> names_;  // null: indices
};

/// The fibres at one moment of a recording.
struct FiberFrame {
  std::int64_t frame = 0;  ///< the frame's number in the file
  FiberAssembly fibers;
  FiberNames names{};
};

/// The content of a fibre file: one frame without a number, or any number of numbered ones.
struct FiberFile {
  bool has_frames = false;
  std::vector<FiberFrame> frames;  ///< in the file's order, see read_csv(); one without numbers

  /// Tells of all in the file that is not in here, such as unknown columns: a sentence each.
  std::vector<std::string> notes{};
};

/// How fibres are read.
struct ReadOptions {
  // Not explicit: whoever gives a number alone gives the radius.
  ReadOptions(double radius = 0.0) : default_radius(radius) {}

  double default_radius;  ///< [m] of all fibres if the file has no radii

  /// Whether fibres of fewer than two points are left out, and FiberFile::notes tells how many
  /// there were; else such a file is refused.
  bool skip_single_points = false;
};

// ---- CSV

/// Reads a fibre file: a header, then a row per point. Columns are found by their names, in any
/// order and in capitals or not: `x`, `y`, `z` [m], and where there are any `frame`, a whole
/// number, `fiber`, any text, `radius` [m], `closed`, 1 in all rows of a closed fibre and 0 in
/// those of an open one, and `joint`, a whole number that rows of one place share, negative or
/// nothing elsewhere. Others are left out, and FiberFile::notes names them; without `fiber` all
/// rows of a frame are one fibre. The points of a fibre are the rows with its name, in their order,
/// wherever they stand. Frames are in the file's order, or in that of their numbers where their
/// rows are mixed; the fibres of each are in the order in which they first appear.
///
/// Values are separated by commas, semicolons, tabs or blanks, as the header is; those in quotes
/// may hold anything but a line's end (RFC 4180). Blanks around values, blank lines, CRLF line ends
/// and lines that begin with # are allowed; the header may be such a line. A line has at most
/// 65 536 bytes, a value 4 096.
/// @param options the default radius is that of a file without a radius column
/// @throws FileError
/// @throws std::invalid_argument for a bad default radius
FiberFile read_csv(const std::string& path, const ReadOptions& options = {});

/// read_csv() from a stream; errors call it by `name`.
FiberFile read_csv(std::istream& stream, const std::string& name, const ReadOptions& options = {});

/// Writes a fibre file frame by frame, so that a long one never is in memory. The radius column is
/// that of the point if there is one per point, else that of its fibre. Where fibres of the first
/// frame are closed or joined, there are the columns closed and joint. All numbers read back as the
/// same.
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
  void write_header(bool has_topology);

  const bool has_frames_;
  OutputFile file_;
  std::optional<bool> has_topology_;  // as the header has it, once it is written
  std::set<std::int64_t> frames_written_;
  std::string rows_;
};

/// Writes all of a fibre file; see CsvWriter.
void write_csv(const std::string& path, const FiberFile& file);

// ---- the HAIR format of Cem Yuksel (www.cemyuksel.com/research/hairmodels). All numbers are
// little-endian. A header of 128 bytes: "HAIR", then at these bytes
//    4 number of strands, 8 number of points, 12 flags, 16 default segments (uint32),
//   20 default thickness, 24 default transparency, 28 default colour (1, 1 and 3 float32),
//   40 information for people (88 bytes);
// then the arrays that the flags announce, in this order:
//   bit 0 segments of each strand (uint16), bit 1 points (3 float32), bit 2 thickness,
//   bit 3 transparency (float32 each), bit 4 colour (3 float32), all of them per point.
// The format states no unit of length: numbers are taken as metres.

/// Reads a .hair file as one frame without a number. The strands become fibres in the file's order;
/// half of a thickness is a radius. Transparency and colour have no place in an assembly.
/// @param options the default radius is that of a file with neither a thickness array nor a default
///        thickness other than 0; a strand of 0 segments is a fibre of one point
/// @throws FileError naming the field and its byte; also for bytes that the header does not account
///         for. The header is compared with the size of the file before anything is allocated by
///         it.
/// @throws std::invalid_argument for a bad default radius
FiberFile read_hair(const std::string& path, const ReadOptions& options = {});

/// read_hair() from a stream, which must be able to seek; errors call it by `name`.
FiberFile read_hair(std::istream& stream, const std::string& name, const ReadOptions& options = {});

/// Writes a .hair file. Coordinates and radii are rounded to single precision, all that the format
/// has. The arrays of segments and thickness are written only if one value does not serve all.
/// @throws FileError
/// @throws std::invalid_argument if a file cannot hold this: anything but one frame without a
///         number, fibres that differ in segments and have more than 65 535 of them, or numbers
///         beyond single precision
void write_hair(const std::string& path, const FiberFile& file);

/// write_hair() to a stream, which is not checked for errors.
void write_hair(std::ostream& stream, const FiberFile& file);

// ---- for ParaView

/// Writes fibres over time for ParaView: NAME.pvd names a file for each frame beside it,
/// NAME_000000.vtp and so on, with the fibres as poly lines and `radius` [m] and `fiber`, the
/// index, at their points. All numbers read back as the same. What is written can be opened after
/// each frame.
class PvdWriter {
 public:
  /// @param path of the .pvd file
  /// @throws FileError
  explicit PvdWriter(const std::string& path);

  /// @param time of the frame [s]
  /// @throws FileError
  void write(const FiberFrame& frame, double time);

 private:
  void append(const std::string& text);

  const std::string path_;
  OutputFile file_;
  std::streampos end_;  // of the frames in the file, where the last tags begin
};

/// Writes fibres as a VTK file of poly data, in XML, to a stream, which is not checked for errors.
void write_vtp(std::ostream& stream, const FiberAssembly& fibers);

// ---- any format: the end of the name decides, in capitals or not. A name of another format that
// is known, as .json or .npy, is refused; one that means no format is CSV.

/// Reads a fibre file of any format: .csv, .hair, .tck, .trk, .vtp, .vtk, .npz or .swc;
/// docs/library.md tells what is read of each, and in which unit. HDF5 is read over ranks only
/// (fiber_proximity/mpi/distributed_files.hpp).
/// @throws FileError
/// @throws std::invalid_argument for a bad default radius
FiberFile read_fibers(const std::string& path, const ReadOptions& options = {});

/// Writes a fibre file of any format frame by frame: .csv, .pvd, and of one frame .hair, .tck,
/// .trk, .vtp or .npz.
class FiberWriter {
 public:
  /// @param has_frames whether frames have numbers, which only .csv and .pvd files can hold;
  ///        without them the file holds exactly one
  /// @throws std::invalid_argument for a name of a format that is not written
  /// @throws FileError
  FiberWriter(const std::string& path, bool has_frames);

  /// @param time of the frame [s], which only .pvd files hold; none: the frame's number
  /// @throws std::invalid_argument for a frame that the file cannot hold
  /// @throws FileError
  void write(const FiberFrame& frame, std::optional<double> time = std::nullopt);

  /// Call once, after the last frame: only then is all of it in the file.
  /// @throws FileError
  void finish();

 private:
  std::string end_of_name() const;

  const std::string path_;
  const bool has_frames_;
  bool wrote_frame_ = false;
  std::optional<CsvWriter> csv_;
  std::optional<PvdWriter> pvd_;  // neither for a format of one frame
};

/// Writes all of a fibre file; see FiberWriter.
void write_fibers(const std::string& path, const FiberFile& file);

}  // namespace fiber
