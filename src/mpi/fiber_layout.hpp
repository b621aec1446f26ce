#pragma once

#include <cstdint>

#include "src/mpi/hdf5_file.hpp"

namespace fiber {

/// Names in our files of fibres and contacts (docs/distributed.md). Those of VTK are as VTKHDF has
/// them.
namespace layout {
constexpr const char* fibers = "fibers";
constexpr const char* contacts = "contacts";
constexpr const char* frames = "frames";
constexpr const char* fiber_names = "fiber_names";

constexpr const char* vtk = "VTKHDF";
constexpr const char* at_points = "PointData";
constexpr const char* at_cells = "CellData";
constexpr const char* points = "Points";
constexpr const char* connectivity = "Connectivity";
constexpr const char* offsets = "Offsets";
constexpr const char* types = "Types";

constexpr const char* radius = "radius";
constexpr const char* fiber = "fiber";
constexpr const char* first_segment = "first_segment";

constexpr std::uint8_t line = 3;       // VTK_LINE
constexpr std::uint8_t poly_line = 4;  // VTK_POLY_LINE
}  // namespace layout

/// How many lines, parts of fibres, and how many points they have.
struct FiberCounts {
  std::uint64_t lines = 0;
  std::uint64_t points = 0;

  FiberCounts& operator+=(const FiberCounts& other) {
    lines += other.lines;
    points += other.points;
    return *this;
  }
};

/// How many of each an unstructured grid of VTK has, which is one piece here.
class VtkSizes {
 public:
  struct Counts {
    std::uint64_t points = 0;
    std::uint64_t cells = 0;
    std::uint64_t connectivity = 0;
  };

  /// Makes their datasets, and the attributes of the group. Collective.
  VtkSizes(hid_t vtk, const Counts& counts)
      : points_(vtk, "NumberOfPoints", 1, 0),
        cells_(vtk, "NumberOfCells", 1, 0),
        connectivity_(vtk, "NumberOfConnectivityIds", 1, 0) {
    write_numbers(vtk, "Version", {1, 0});
    write_text(vtk, "Type", "UnstructuredGrid");
    points_.append(static_cast<std::int64_t>(counts.points));
    cells_.append(static_cast<std::int64_t>(counts.cells));
    connectivity_.append(static_cast<std::int64_t>(counts.connectivity));
  }

  /// Called by one rank.
  void write() {
    points_.flush();
    cells_.flush();
    connectivity_.flush();
  }

 private:
  RowWriter<std::int64_t> points_;
  RowWriter<std::int64_t> cells_;
  RowWriter<std::int64_t> connectivity_;
};

/// Writes where the last line ends. Called by one rank.
inline void write_end(hid_t offsets, const FiberCounts& all) {
  const auto end = static_cast<std::int64_t>(all.points);
  write_rows(offsets, hdf5_type(end).memory, all.lines, {1, 1}, &end);
}

}  // namespace fiber
