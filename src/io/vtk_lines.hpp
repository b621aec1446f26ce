#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "src/io/number_array.hpp"
#include "src/io/strands.hpp"

namespace fiber {

/// Numbers of a VTK file, and what errors call their array.
struct VtkArray {
  NumberArray numbers;
  std::string place;
};

/// Points of a VTK file, and the lines between them.
struct VtkPiece {
  VtkArray points;                 // three numbers each
  std::optional<VtkArray> radii;   // of the points
  std::optional<VtkArray> joints;  // of the points, whole numbers as FiberTopology has them
  VtkArray ends;                   // where the lines end in `ids`, one after the other
  VtkArray ids;                    // of points
};

/// Puts strands together from pieces of a VTK file of poly data. A line whose last point is its
/// first one is closed, and points that lines share are joints.
class VtkLines {
 public:
  /// @param name what errors call the file; it stays where it is
  explicit VtkLines(const std::string& name) : name_(name) {}

  /// @throws FileError
  void add(const VtkPiece& piece);

  /// Cells that are no lines: vertices, polygons and strips.
  void skip_cells(std::uint64_t count) { other_cells_ += count; }

  /// An array that is not read.
  void skip_array(std::string_view array);

  /// @throws FileError for a file that has something but no lines
  Strands finish();

 private:
  [[noreturn]] void refuse(const std::string& reason) const { throw FileError(name_, reason); }
  void add_line(const VtkPiece& piece, std::size_t line, std::size_t begin, std::size_t end);
  void add_point(const VtkPiece& piece, std::size_t line, std::size_t id);
  std::size_t id_at(const VtkPiece& piece, std::size_t line, std::size_t index) const;
  void join(const VtkPiece& piece, std::size_t first_point);

  const std::string& name_;
  Strands strands_;
  std::uint64_t other_cells_ = 0;
  std::uint64_t points_ = 0;
  std::uint64_t unused_points_ = 0;
  std::vector<std::size_t> ids_;     // of the points of the strands, in their piece
  std::int64_t joint_count_ = 0;     // numbers in use, from 0 on
  std::vector<std::string> arrays_;  // not read
};

}  // namespace fiber
