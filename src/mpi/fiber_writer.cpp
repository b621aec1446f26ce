#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>
#include <string>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/radii.hpp"
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
  FiberCounts own;
  FiberCounts before;  // of the ranks before
  FiberCounts all;
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
  for (std::size_t part = 0; part < count; ++part) {
    const bool is_joined = before && *before == end_of(fibers, part, true);
    lines.is_joined.push_back(is_joined);
    lines.own.lines += is_joined ? 0 : 1;
    lines.own.points +=
        fibers.parts.offsets()[part + 1] - fibers.parts.offsets()[part] - (is_joined ? 1 : 0);
    before = end_of(fibers, part, false);
  }
  const std::vector<FiberCounts> counts = ranks.gather_all(lines.own);
  for (int other = 0; other < ranks.size(); ++other) {
    const FiberCounts& some = counts[static_cast<std::size_t>(other)];
    lines.all += some;
    lines.before += other < ranks.rank() ? some : FiberCounts{};
  }
  return lines;
}

/// The datasets of a frame. All ranks make them alike, then each writes its rows.
class FiberDatasets {
 public:
  FiberDatasets(hid_t file, const RankLines& lines, bool is_root)
      : vtk_(create_group(file, layout::vtk)),
        at_points_(create_group(vtk_.get(), layout::at_points)),
        at_cells_(create_group(vtk_.get(), layout::at_cells)),
        is_root_(is_root),
        next_point_(lines.before.points),
        all_(lines.all),
        points_(vtk_.get(), layout::points, all_.points, lines.before.points),
        connectivity_(vtk_.get(), layout::connectivity, all_.points, lines.before.points),
        offsets_(vtk_.get(), layout::offsets, all_.lines + 1, lines.before.lines),
        types_(vtk_.get(), layout::types, all_.lines, lines.before.lines),
        radii_(at_points_.get(), layout::radius, all_.points, lines.before.points),
        fibers_(at_cells_.get(), layout::fiber, all_.lines, lines.before.lines),
        first_segments_(at_cells_.get(), layout::first_segment, all_.lines, lines.before.lines),
        sizes_(vtk_.get(), {all_.points, all_.lines, all_.points}) {}

  void write(const DistributedFibers& fibers, const RankLines& lines) {
    for (std::size_t part = 0; part < fibers.names.size(); ++part) {
      std::uint32_t point = fibers.parts.offsets()[part];
      if (lines.is_joined[part]) {
        ++point;  // the part before has it
      } else {
        begin_line(fibers.names[part]);
      }
      for (; point < fibers.parts.offsets()[part + 1]; ++point) {
        const Eigen::Vector3d& p = fibers.parts.points()[point];
        points_.append(p[0], p[1], p[2]);
        radii_.append(fibers.parts.radius_at(part, point));
        connectivity_.append(static_cast<std::int64_t>(next_point_++));
      }
    }
    flush();
    if (is_root_) {
      sizes_.write();
      write_end(offsets_.dataset(), all_);
    }
  }

 private:
  void begin_line(const FiberPart& name) {
    offsets_.append(static_cast<std::int64_t>(next_point_));
    types_.append(layout::poly_line);
    fibers_.append(name.fiber);
    first_segments_.append(name.first_segment);
  }

  void flush() {
    points_.flush();
    connectivity_.flush();
    offsets_.flush();
    types_.flush();
    radii_.flush();
    fibers_.flush();
    first_segments_.flush();
  }

  Hdf5Id vtk_;
  Hdf5Id at_points_;
  Hdf5Id at_cells_;
  const bool is_root_;
  std::uint64_t next_point_;
  const FiberCounts all_;
  RowWriter<double, 3> points_;
  RowWriter<std::int64_t> connectivity_;
  RowWriter<std::int64_t> offsets_;
  RowWriter<std::uint8_t> types_;
  RowWriter<double> radii_;
  RowWriter<std::uint64_t> fibers_;
  RowWriter<std::uint64_t> first_segments_;
  VtkSizes sizes_;
};

/// [byte]
std::uint64_t size_of(const FiberCounts& all) { return 40 * all.points + 25 * all.lines; }

}  // namespace

struct DistributedFiberWriter::State {
  Communicator ranks;
  FrameFiles files;

  State(MPI_Comm comm, const std::string& path, const DistributedFileOptions& options)
      : ranks(comm), files(ranks, path, layout::fibers, options) {}
};

DistributedFiberWriter::DistributedFiberWriter(MPI_Comm ranks, const std::string& path,
                                               const DistributedFileOptions& options)
    : state_(std::make_unique<State>(ranks, path, options)) {}

DistributedFiberWriter::~DistributedFiberWriter() = default;

std::size_t DistributedFiberWriter::done() const { return state_->files.done(); }

void DistributedFiberWriter::write(std::int64_t frame, const DistributedFibers& fibers) {
  const Communicator& ranks = state_->ranks;
  const std::size_t count = fibers.parts.fiber_count();
  ranks.throw_on_all(fibers.names.size() == count
                         ? ""
                         : std::to_string(fibers.names.size()) + " names for " +
                               std::to_string(count) + " parts, there must be one per part");
  ranks.throw_on_all(error_in([&] { require_names(fibers); }));
  const RankLines lines = lines_of(ranks, fibers);
  const std::uint64_t size = size_of(lines.all) + size_of_names(fibers.fiber_names);
  state_->files.write(frame, size, [&](hid_t file) -> std::function<void()> {
    const auto datasets = std::make_shared<FiberDatasets>(file, lines, ranks.rank() == 0);
    return [&, datasets, write_names = create_names(file, fibers.fiber_names)] {
      datasets->write(fibers, lines);
      if (ranks.rank() == 0) {
        write_names();
      }
    };
  });
}

void DistributedFiberWriter::finish() { state_->files.finish(); }

}  // namespace fiber
