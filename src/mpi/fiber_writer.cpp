#include <algorithm>
#include <cmath>
#include <optional>
#include <string>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/radii.hpp"
#include "src/mpi/error_of_joints.hpp"
#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/fiber_name_data.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/frame_files.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {
namespace {

/// Whether numbers are the same in a file: -0 is another than 0.
bool has_same_bits(double x, double y) { return x == y && std::signbit(x) == std::signbit(y); }

/// A point where a part may go on: it does at a point that has the same of all of this.
struct PartEnd {
  GlobalSegment next;  // the segment that starts here
  Eigen::Vector3d point{};
  double radius = 0.0;

  bool operator==(const PartEnd& other) const {
    return !(next < other.next) && !(other.next < next) &&
           std::equal(point.begin(), point.end(), other.point.begin(), has_same_bits) &&
           has_same_bits(radius, other.radius);
  }
};

PartEnd end_of(const DistributedFibers& fibers, std::size_t part, bool is_start) {
  const std::uint32_t begin = fibers.parts.offsets()[part];
  const std::uint32_t point = is_start ? begin : fibers.parts.offsets()[part + 1] - 1;
  const FiberPart& name = fibers.names[part];
  return {{name.fiber, name.first_segment + (point - begin)},
          fibers.parts.points()[point],
          fibers.parts.radius_at(part, point)};
}

/// The lines that the parts of a rank become in the file.
struct RankLines {
  std::vector<bool> is_joined;  // to the part before it, by part
  RankShare lines;
  RankShare points;
};

RankLines lines_of(const Communicator& ranks, const DistributedFibers& fibers) {
  struct Ends {
    bool has_parts = false;
    PartEnd last;
  };
  const std::size_t count = fibers.names.size();
  Ends ends;
  if (count > 0) {
    ends = {true, end_of(fibers, count - 1, false)};
  }
  std::optional<PartEnd> before;
  const std::vector<Ends> of_all = ranks.gather_all(ends);
  for (int other = 0; other < ranks.rank(); ++other) {
    const Ends& some = of_all[static_cast<std::size_t>(other)];
    before = some.has_parts ? some.last : before;
  }
  RankLines lines;
  std::uint64_t line_count = 0;
  std::uint64_t point_count = fibers.parts.point_count();
  for (std::size_t part = 0; part < count; ++part) {
    const bool is_joined = before && *before == end_of(fibers, part, true);
    lines.is_joined.push_back(is_joined);
    line_count += is_joined ? 0 : 1;
    point_count -= is_joined ? 1 : 0;
    before = end_of(fibers, part, false);
  }
  lines.lines = ranks.share(line_count);
  lines.points = ranks.share(point_count);
  return lines;
}

/// Goes through what a rank writes.
struct FiberRows {
  const DistributedFibers& fibers;
  const RankLines& lines;

  /// Calls with the name of each part that begins a line, and the number of its first point in the
  /// file.
  template <class Call>
  void for_each_line(const Call& call) const {
    std::uint64_t first_point = lines.points.before;
    for (std::size_t part = 0; part < fibers.names.size(); ++part) {
      if (!lines.is_joined[part]) {
        call(fibers.names[part], first_point);
      }
      first_point += fibers.parts.offsets()[part + 1] - first_of(part);
    }
  }

  /// Calls with each point, and with its part.
  template <class Call>
  void for_each_point(const Call& call) const {
    for (std::size_t part = 0; part < fibers.names.size(); ++part) {
      for (std::uint32_t p = first_of(part); p < fibers.parts.offsets()[part + 1]; ++p) {
        call(part, p);
      }
    }
  }

 private:
  /// The first point of a part that the part before it does not have.
  std::uint32_t first_of(std::size_t part) const {
    return fibers.parts.offsets()[part] + (lines.is_joined[part] ? 1 : 0);
  }
};

void add_fibers(FrameDatasets& datasets, hid_t file, const Communicator& ranks,
                const FiberRows& rows) {
  const Hdf5Id vtk = create_group(file, layout::vtk);
  const Hdf5Id at_points = create_group(vtk.get(), layout::at_points);
  const Hdf5Id at_cells = create_group(vtk.get(), layout::at_cells);
  const RankShare& lines = rows.lines.lines;
  const RankShare& points = rows.lines.points;
  datasets.add<double, 3>(vtk.get(), layout::points, points, [rows](auto& to) {
    rows.for_each_point([&](std::size_t /*part*/, std::uint32_t p) {
      const Eigen::Vector3d& point = rows.fibers.parts.points()[p];
      to.append(point[0], point[1], point[2]);
    });
  });
  datasets.add<std::int64_t>(vtk.get(), layout::connectivity, points, [rows](auto& to) {
    auto next = static_cast<std::int64_t>(rows.lines.points.before);
    rows.for_each_point([&](std::size_t /*part*/, std::uint32_t /*p*/) { to.append(next++); });
  });
  const bool is_last = ranks.rank() == ranks.size() - 1;  // which also writes where all lines end
  datasets.add<std::int64_t>(
      vtk.get(), layout::offsets, {lines.before, lines.all + 1}, [rows, is_last](auto& to) {
        rows.for_each_line([&](const FiberPart& /*name*/, std::uint64_t first_point) {
          to.append(static_cast<std::int64_t>(first_point));
        });
        if (is_last) {
          to.append(static_cast<std::int64_t>(rows.lines.points.all));
        }
      });
  const auto add_to_lines = [&](hid_t place, const char* name, const auto& value_of) {
    using Value = decltype(value_of(FiberPart()));
    datasets.add<Value>(place, name, lines, [rows, value_of](auto& to) {
      rows.for_each_line(
          [&](const FiberPart& part, std::uint64_t /*first_point*/) { to.append(value_of(part)); });
    });
  };
  add_to_lines(vtk.get(), layout::types,
               [](const FiberPart& /*part*/) { return layout::poly_line; });
  datasets.add<double>(at_points.get(), layout::radius, points, [rows](auto& to) {
    rows.for_each_point([&](std::size_t part, std::uint32_t p) {
      to.append(rows.fibers.parts.radius_at(part, p));
    });
  });
  add_to_lines(at_cells.get(), layout::fiber, [](const FiberPart& part) { return part.fiber; });
  add_to_lines(at_cells.get(), layout::first_segment,
               [](const FiberPart& part) { return part.first_segment; });
  add_vtk_sizes(datasets, vtk.get(), {points.all, lines.all, points.all}, ranks.rank() == 0);
}

}  // namespace

DistributedFiberWriter::DistributedFiberWriter(MPI_Comm ranks, const std::string& path,
                                               const DistributedFileOptions& options)
    : DistributedFileWriter(ranks, path, layout::fibers, options) {}

void DistributedFiberWriter::write(std::int64_t frame, const DistributedFibers& fibers) {
  const Communicator& ranks = state_->ranks;
  const std::size_t count = fibers.parts.fiber_count();
  ranks.throw_on_all(fibers.names.size() == count
                         ? error_of_joints(fibers.parts)
                         : std::to_string(fibers.names.size()) + " names for " +
                               std::to_string(count) + " parts, there must be one per part");
  ranks.throw_on_all(error_in([&] { require_names(fibers); }));
  const RankLines lines = lines_of(ranks, fibers);
  const std::uint64_t size =
      40 * lines.points.all + 25 * lines.lines.all + size_of_names(fibers.fiber_names);
  state_->files.write(frame, size, [&](hid_t file, FrameDatasets& datasets) {
    add_fibers(datasets, file, ranks, {fibers, lines});
    add_names(datasets, file, fibers.fiber_names, ranks.rank() == 0);
  });
}

}  // namespace fiber
