#pragma once

#include <cstdint>

#include "src/mpi/frame_datasets.hpp"

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
constexpr const char* joint = "joint";    // of a point, below 0 for none
constexpr const char* closed = "closed";  // of a line: 1 if its fibre is

constexpr std::uint8_t line = 3;       // VTK_LINE
constexpr std::uint8_t poly_line = 4;  // VTK_POLY_LINE
}  // namespace layout

/// How many of each an unstructured grid of VTK has.
struct VtkSizes {
  std::uint64_t points = 0;
  std::uint64_t cells = 0;
  std::uint64_t connectivity = 0;
};

/// Adds what says that a group is such a grid, of one piece. Collective.
inline void add_vtk_sizes(FrameDatasets& datasets, hid_t vtk, const VtkSizes& sizes, bool is_root) {
  const auto add = [&](const char* name, std::uint64_t size) {
    datasets.add<std::int64_t>(vtk, name, {0, 1}, [size, is_root](auto& rows) {
      if (is_root) {
        rows.append(static_cast<std::int64_t>(size));
      }
    });
  };
  add("NumberOfPoints", sizes.points);
  add("NumberOfCells", sizes.cells);
  add("NumberOfConnectivityIds", sizes.connectivity);
  write_numbers(vtk, "Version", {1, 0});
  write_text(vtk, "Type", "UnstructuredGrid");
}

}  // namespace fiber
