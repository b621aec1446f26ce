#include <algorithm>
#include <cmath>
#include <optional>
#include <string>
#include <utility>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/radii.hpp"
#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/fiber_name_data.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/frame_files.hpp"
#include "src/mpi/hdf5_file.hpp"
#include "src/mpi/part_topology.hpp"

namespace fiber {
namespace {

/// Whether numbers are the same in a file: -0 is another than 0.
bool has_same_bits(double x, double y) { return x == y && std::signbit(x) == std::signbit(y); }

/// A point where a part may go on: it does at a point that has the same of all of this.
struct PartEnd {
  GlobalSegment next;  // the segment that starts here
  Eigen::Vector3d point{};
  double radius = 0.0;
  std::int32_t joint = -1;
  bool is_closed = false;

  bool operator==(const PartEnd& other) const {
    return !(next < other.next) && !(other.next < next) &&
           std::equal(point.begin(), point.end(), other.point.begin(), has_same_bits) &&
           has_same_bits(radius, other.radius) && joint == other.joint &&
           is_closed == other.is_closed;
  }
};

/// The fibres that a rank writes.
struct WrittenFibers {
  const DistributedFibers& fibers;
  const FiberTopology topology;

  std::int32_t joint_of(std::uint32_t point) const {
    return topology.joints.empty() ? -1 : std::max(-1, topology.joints[point]);
  }
  bool is_closed(std::size_t part) const {
    return !topology.closed.empty() && topology.closed[part] != 0;
  }
};

PartEnd end_of(const WrittenFibers& written, std::size_t part, bool is_start) {
  const FiberAssembly& parts = written.fibers.parts;
  const std::uint32_t begin = parts.offsets()[part];
  const std::uint32_t point = is_start ? begin : parts.offsets()[part + 1] - 1;
  const FiberPart& name = written.fibers.names[part];
  return {{name.fiber, name.first_segment + (point - begin)},
          parts.points()[point],
          parts.radius_at(part, point),
          written.joint_of(point),
          written.is_closed(part)};
}

/// The lines that the parts of a rank become in the file.
struct RankLines {
  std::vector<bool> goes_on;  // the part before it, by part
  RankShare lines;
  RankShare points;
};

RankLines lines_of(const Communicator& ranks, const WrittenFibers& written) {
  struct Ends {
    bool has_parts = false;
    PartEnd last;
  };
  const std::size_t count = written.fibers.names.size();
  Ends ends;
  if (count > 0) {
    ends = {true, end_of(written, count - 1, false)};
  }
  std::optional<PartEnd> before;
  const std::vector<Ends> of_all = ranks.gather_all(ends);
  for (int other = 0; other < ranks.rank(); ++other) {
    const Ends& some = of_all[static_cast<std::size_t>(other)];
    before = some.has_parts ? some.last : before;
  }
  RankLines lines;
  std::uint64_t line_count = 0;
  std::uint64_t point_count = written.fibers.parts.point_count();
  for (std::size_t part = 0; part < count; ++part) {
    const bool goes_on = before && *before == end_of(written, part, true);
    lines.goes_on.push_back(goes_on);
    line_count += goes_on ? 0 : 1;
    point_count -= goes_on ? 1 : 0;
    before = end_of(written, part, false);
  }
  lines.lines = ranks.share(line_count);
  lines.points = ranks.share(point_count);
  return lines;
}

/// Goes through what a rank writes.
struct FiberRows {
  const WrittenFibers& written;
  const RankLines& lines;

  /// Calls with each part that begins a line, and the number of its first point in the file.
  template <class Call>
  void for_each_line(const Call& call) const {
    std::uint64_t first_point = lines.points.before;
    for (std::size_t part = 0; part < written.fibers.names.size(); ++part) {
      if (!lines.goes_on[part]) {
        call(part, first_point);
      }
      first_point += written.fibers.parts.offsets()[part + 1] - first_of(part);
    }
  }

  /// Calls with each point, and with its part.
  template <class Call>
  void for_each_point(const Call& call) const {
    const std::vector<std::uint32_t>& offsets = written.fibers.parts.offsets();
    for (std::size_t part = 0; part < written.fibers.names.size(); ++part) {
      for (std::uint32_t p = first_of(part); p < offsets[part + 1]; ++p) {
        call(part, p);
      }
    }
  }

 private:
  /// The first point of a part that the part before it does not have.
  std::uint32_t first_of(std::size_t part) const {
    return written.fibers.parts.offsets()[part] + (lines.goes_on[part] ? 1 : 0);
  }
};

void add_fibers(FrameDatasets& datasets, hid_t file, const Communicator& ranks,
                const FiberRows& rows, bool has_joints) {
  const Hdf5Id vtk = create_group(file, layout::vtk);
  const Hdf5Id at_points = create_group(vtk.get(), layout::at_points);
  const Hdf5Id at_cells = create_group(vtk.get(), layout::at_cells);
  const RankShare& lines = rows.lines.lines;
  const RankShare& points = rows.lines.points;
  datasets.add<double, 3>(vtk.get(), layout::points, points, [rows](auto& to) {
    rows.for_each_point([&](std::size_t /*part*/, std::uint32_t p) {
      const Eigen::Vector3d& point = rows.written.fibers.parts.points()[p];
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
        rows.for_each_line([&](std::size_t /*part*/, std::uint64_t first_point) {
          to.append(static_cast<std::int64_t>(first_point));
        });
        if (is_last) {
          to.append(static_cast<std::int64_t>(rows.lines.points.all));
        }
      });
  const auto add_to_lines = [&](hid_t place, const char* name, const auto& value_of) {
    using Value = decltype(value_of(std::size_t()));
    datasets.add<Value>(place, name, lines, [rows, value_of](auto& to) {
      rows.for_each_line(
          [&](std::size_t part, std::uint64_t /*first_point*/) { to.append(value_of(part)); });
    });
  };
  const std::vector<FiberPart>& names = rows.written.fibers.names;
  add_to_lines(vtk.get(), layout::types, [](std::size_t /*part*/) { return layout::poly_line; });
  datasets.add<double>(at_points.get(), layout::radius, points, [rows](auto& to) {
    rows.for_each_point([&](std::size_t part, std::uint32_t p) {
      to.append(rows.written.fibers.parts.radius_at(part, p));
    });
  });
  add_to_lines(at_cells.get(), layout::fiber,
               [&names](std::size_t part) { return names[part].fiber; });
  add_to_lines(at_cells.get(), layout::first_segment,
               [&names](std::size_t part) { return names[part].first_segment; });
  if (has_joints) {
    datasets.add<std::int64_t>(at_points.get(), layout::joint, points, [rows](auto& to) {
      rows.for_each_point([&](std::size_t /*part*/, std::uint32_t p) {
        to.append(std::int64_t{rows.written.joint_of(p)});
      });
    });
    add_to_lines(at_cells.get(), layout::closed, [rows](std::size_t part) {
      return static_cast<std::uint8_t>(rows.written.is_closed(part) ? 1 : 0);
    });
  }
  add_vtk_sizes(datasets, vtk.get(), {points.all, lines.all, points.all}, ranks.rank() == 0);
}

}  // namespace

DistributedFiberWriter::DistributedFiberWriter(MPI_Comm ranks, const std::string& path,
                                               const DistributedFileOptions& options)
    : DistributedFileWriter(ranks, path, layout::fibers, options) {}

void DistributedFiberWriter::write(std::int64_t frame, const DistributedFibers& fibers) {
  const Communicator& ranks = state_->ranks;
  const std::size_t count = fibers.parts.fiber_count();
  FiberTopology topology;
  const std::string error =
      error_in([&] { topology = part_topology(fibers.parts, fibers.topology); });
  ranks.throw_on_all(fibers.names.size() == count
                         ? error
                         : std::to_string(fibers.names.size()) + " names for " +
                               std::to_string(count) + " parts, there must be one per part");
  ranks.throw_on_all(error_in([&] { require_names(fibers); }));
  const bool has_joints = !ranks.all(!joins_anything(topology));
  const std::optional<double> tolerance = common_tolerance(ranks, topology);
  const WrittenFibers written{fibers, std::move(topology)};
  const RankLines lines = lines_of(ranks, written);
  FrameFacts facts;
  facts.number = frame;
  facts.version = has_joints ? layout_version_of_joints : layout_version;
  facts.data_size = (has_joints ? 48 : 40) * lines.points.all +
                    (has_joints ? 26 : 25) * lines.lines.all + size_of_names(fibers.fiber_names);
  state_->files.write(facts, [&](hid_t file, FrameDatasets& datasets) {
    if (tolerance) {
      write_real(file, attribute::joint_tolerance, *tolerance);
    }
    add_fibers(datasets, file, ranks, {written, lines}, has_joints);
    add_names(datasets, file, fibers.fiber_names, ranks.rank() == 0);
  });
}

}  // namespace fiber
