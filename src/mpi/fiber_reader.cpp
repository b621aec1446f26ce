#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <exception>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <utility>

#include "fiber_proximity/io/file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/io/radii.hpp"
#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/fiber_name_data.hpp"
#include "src/mpi/frame_files.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {
namespace {

/// A segment of the file: the line it is part of, and its first point.
struct FileSegment {
  std::uint64_t line = 0;
  std::uint64_t point = 0;
};

template <class T>
std::vector<T> read_values(hid_t dataset, std::uint64_t first, std::uint64_t count) {
  std::vector<T> values(count);
  read_rows(dataset, hdf5_type(T()).memory, first, {count}, values.data());
  return values;
}

/// How many lines, parts of fibres, and how many points they have.
struct FiberCounts {
  std::uint64_t lines = 0;
  std::uint64_t points = 0;
};

/// The datasets of a frame, to read.
class FiberData {
 public:
  explicit FiberData(hid_t frame)
      : vtk_(open_group(frame, layout::vtk)),
        points_(open_dataset(vtk_.get(), layout::points)),
        offsets_(open_dataset(vtk_.get(), layout::offsets)),
        radii_(open_at(layout::at_points, layout::radius)),
        fibers_(open_at(layout::at_cells, layout::fiber)),
        first_segments_(open_at(layout::at_cells, layout::first_segment)) {
    const Hdf5Shape points = shape_of(points_.get());
    if (points.columns != 3) {
      throw std::runtime_error("dataset Points has " + std::to_string(points.columns) +
                               " columns, it must have 3");
    }
    all_ = {require_rows(fibers_, layout::fiber, std::nullopt), points.rows};
    require_rows(radii_, layout::radius, all_.points);
    require_rows(first_segments_, layout::first_segment, all_.lines);
    require_rows(offsets_, layout::offsets, all_.lines + 1);
    if (offset(0) != 0 || offset(all_.lines) != all_.points) {
      throw std::runtime_error("Offsets begin with " + std::to_string(offset(0)) +
                               " and end with " + std::to_string(offset(all_.lines)) +
                               ", they must with 0 and " + std::to_string(all_.points) +
                               ", as there are points");
    }
    if (all_.points < 2 * all_.lines) {
      throw std::runtime_error(std::to_string(all_.points) + " points for " +
                               std::to_string(all_.lines) + " lines, each must have two or more");
    }
  }

  std::uint64_t segment_count() const { return all_.points - all_.lines; }

  /// Finds the segment that has so many before it. Offsets need not be right.
  FileSegment find(std::uint64_t before) const {
    if (before >= segment_count()) {
      return {all_.lines, all_.points};
    }
    if (before == 0) {
      return {};  // also before lines without a segment, so that these are seen and refused
    }
    std::uint64_t begin = 0;
    std::uint64_t end = all_.lines;
    while (end - begin > 1) {
      const std::uint64_t middle = begin + (end - begin) / 2;
      (offset(middle) - middle <= before ? begin : end) = middle;
    }
    return {begin, before + begin};
  }

  /// The segments from one up to another.
  DistributedFibers read(const FileSegment& begin, const FileSegment& end) const;

 private:
  Hdf5Id open_at(const char* group, const char* name) const {
    const Hdf5Id place = open_group(vtk_.get(), group);
    return open_dataset(place.get(), name);
  }

  static std::uint64_t require_rows(const Hdf5Id& dataset, const char* name,
                                    std::optional<std::uint64_t> rows) {
    const Hdf5Shape shape = shape_of(dataset.get());
    if (shape.columns != 1 || (rows && shape.rows != *rows)) {
      throw std::runtime_error("dataset " + std::string(name) + " has " +
                               std::to_string(shape.rows) + " rows of " +
                               std::to_string(shape.columns) + " values, it must have " +
                               (rows ? std::to_string(*rows) + ' ' : "") + "rows of 1 value");
    }
    return shape.rows;
  }

  std::uint64_t offset(std::uint64_t line) const {
    return read_values<std::uint64_t>(offsets_.get(), line, 1).front();
  }

  std::vector<std::uint64_t> offsets_of(std::uint64_t begin, std::uint64_t end) const;
  std::vector<Eigen::Vector3d> points_of(std::uint64_t first, std::uint64_t count) const;

  Hdf5Id vtk_;
  Hdf5Id points_;
  Hdf5Id offsets_;
  Hdf5Id radii_;
  Hdf5Id fibers_;
  Hdf5Id first_segments_;
  FiberCounts all_;
};

/// The points at which the lines of a part begin, and the end of the last one.
std::vector<std::uint64_t> FiberData::offsets_of(std::uint64_t begin, std::uint64_t end) const {
  auto offsets = read_values<std::uint64_t>(offsets_.get(), begin, end - begin + 1);
  for (std::size_t i = 0; i + 1 < offsets.size(); ++i) {
    if (offsets[i + 1] < offsets[i] + 2 || offsets[i + 1] > all_.points) {
      throw std::runtime_error("line " + std::to_string(begin + i) + " has points from " +
                               std::to_string(offsets[i]) + " up to " +
                               std::to_string(offsets[i + 1]) +
                               ", each line must have two or more, one line after another");
    }
  }
  return offsets;
}

std::vector<Eigen::Vector3d> FiberData::points_of(std::uint64_t first, std::uint64_t count) const {
  std::vector<Eigen::Vector3d> points(count);
  read_rows(points_.get(), hdf5_type(double()).memory, first, {count, 3}, points.data());
  for (std::uint64_t i = 0; i < count; ++i) {
    for (const double coordinate : points[i]) {
      if (!FiberAssembly::is_valid_coordinate(coordinate)) {
        throw std::runtime_error("point " + std::to_string(first + i) + " has the coordinate " +
                                 fiber::text_of(coordinate) + ", " +
                                 FiberAssembly::coordinate_rule);
      }
    }
  }
  return points;
}

DistributedFibers FiberData::read(const FileSegment& begin, const FileSegment& end) const {
  DistributedFibers fibers;
  if (end.line < begin.line || end.point <= begin.point) {
    if (end.line == begin.line && end.point == begin.point) {
      return fibers;
    }
    throw std::runtime_error("Offsets do not rise from line " + std::to_string(end.line) + " on");
  }
  // A part ends with the last point of its last segment.
  const bool ends_within = end.line < all_.lines && end.point > offset(end.line);
  const std::uint64_t end_line = end.line + (ends_within ? 1 : 0);
  std::vector<std::uint64_t> offsets = offsets_of(begin.line, end_line);
  if (begin.point < offsets.front() || begin.point + 1 >= offsets[1]) {
    throw std::runtime_error("Offsets do not rise about line " + std::to_string(begin.line));
  }
  const std::uint64_t first_offset = offsets.front();
  offsets.front() = begin.point;
  offsets.back() = ends_within ? end.point + 1 : offsets.back();
  const std::uint64_t count = offsets.back() - begin.point;
  if (count > UINT32_MAX) {
    throw std::runtime_error(std::to_string(count) +
                             " points for one rank, there can be 4294967295: take more ranks");
  }
  const auto names = read_values<std::uint64_t>(fibers_.get(), begin.line, end_line - begin.line);
  const auto firsts =
      read_values<std::uint64_t>(first_segments_.get(), begin.line, end_line - begin.line);
  for (std::size_t i = 0; i < names.size(); ++i) {
    fibers.names.push_back({names[i], firsts[i] + (i == 0 ? begin.point - first_offset : 0)});
  }
  std::vector<std::uint32_t> local;
  local.reserve(offsets.size());
  for (const std::uint64_t offset : offsets) {
    local.push_back(static_cast<std::uint32_t>(offset - begin.point));
  }
  std::vector<double> radii = read_values<double>(radii_.get(), begin.point, count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!FiberAssembly::is_valid_radius(radii[i])) {
      throw std::runtime_error("point " + std::to_string(begin.point + i) + " has the radius " +
                               fiber::text_of(radii[i]) + ", " + FiberAssembly::radius_rule);
    }
  }
  fibers.parts = FiberAssembly(points_of(begin.point, count), std::move(local),
                               shared_if_equal(std::move(radii)));
  return fibers;
}

}  // namespace

struct DistributedFiberReader::State {
  State(MPI_Comm comm, std::string file_path) : ranks(comm), path(std::move(file_path)) {}

  Communicator ranks;
  const std::string path;
  std::optional<Hdf5Id> file;
  bool has_frames = false;
  std::size_t frame_count = 1;

  /// Does what may go wrong with the file.
  void do_or_agree(const std::string& place, const std::function<void()>& work) const;
  void open();
};

void DistributedFiberReader::State::do_or_agree(const std::string& place,
                                                const std::function<void()>& work) const {
  const std::string error = error_in(work);
  ranks.throw_on_all(error.empty() ? "" : FileError(path, place + error).what());
}

void DistributedFiberReader::State::open() {
  // Files of frames are looked for beside the file, not beside a link to it.
  file.emplace(open_parallel_file(ranks, std::filesystem::canonical(path).string()));
  if (read_text(file->get(), attribute::content) != layout::fibers) {
    throw std::runtime_error("is no file of fibres: its attribute fiber_proximity is not fibers");
  }
  if (const auto version = read_number(file->get(), attribute::version);
      version != layout_version) {
    throw std::runtime_error("has a layout of version " +
                             (version ? std::to_string(*version) : "none") + ", known is " +
                             std::to_string(layout_version));
  }
  has_frames = read_number(file->get(), attribute::has_frames).value_or(0) != 0;
  if (has_frames) {
    const Hdf5Id frames = open_group(file->get(), layout::frames);
    H5G_info_t info;
    require_success(H5Gget_info(frames.get(), &info), "group frames cannot be read");
    frame_count = info.nlinks;
  }
}

DistributedFiberReader::DistributedFiberReader(MPI_Comm ranks, const std::string& path)
    : state_(std::make_unique<State>(ranks, path)) {
  run_on_root(state_->ranks, [&] {
    errno = 0;
    if (std::ifstream file(path, std::ios::binary); !file) {
      throw FileError::from_system(path, "cannot be opened");
    }
  });
  const QuietHdf5 quiet;
  state_->do_or_agree("", [&] { state_->open(); });
}

DistributedFiberReader::~DistributedFiberReader() = default;

bool DistributedFiberReader::has_frames() const { return state_->has_frames; }

std::size_t DistributedFiberReader::frame_count() const { return state_->frame_count; }

std::int64_t DistributedFiberReader::read(std::size_t index, DistributedFibers& fibers) const {
  const QuietHdf5 quiet;
  const Communicator& ranks = state_->ranks;
  const auto size = static_cast<std::uint64_t>(ranks.size());
  const auto rank = static_cast<std::uint64_t>(ranks.rank());
  const std::string name = std::string(layout::frames) + '/' + frame_name(index);
  std::optional<Hdf5Id> frame;
  std::int64_t number = 0;
  state_->do_or_agree(state_->has_frames ? name + ": " : "", [&] {
    frame.emplace(open_group(state_->file->get(), state_->has_frames ? name : "/"));
    number = read_number(frame->get(), attribute::frame).value_or(0);
    const FiberData data(frame->get());
    const std::uint64_t count = data.segment_count();
    const std::uint64_t rest = count % size;
    const std::uint64_t begin = count / size * rank + std::min(rank, rest);
    const std::uint64_t end = begin + count / size + (rank < rest ? 1 : 0);
    fibers = data.read(data.find(begin), data.find(end));
    fibers.fiber_names = read_names(frame->get());
    require_names(fibers);
  });
  return number;
}

}  // namespace fiber
