#include "src/mpi/fiber_data.hpp"

#include <cstddef>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>

#include "src/geometry/fiber_graph.hpp"
#include "src/io/number.hpp"
#include "src/io/radii.hpp"
#include "src/mpi/fiber_layout.hpp"
#include "src/mpi/frame_files.hpp"

namespace fiber {
namespace {

template <class T>
std::vector<T> read_values(hid_t dataset, std::uint64_t first, std::uint64_t count) {
  std::vector<T> values(count);
  read_rows(dataset, hdf5_type(T()).memory, first, {count}, values.data());
  return values;
}

std::uint64_t require_rows(const Hdf5Id& dataset, const char* name,
                           std::optional<std::uint64_t> rows) {
  const Hdf5Shape shape = shape_of(dataset.get());
  if (shape.columns != 1 || (rows && shape.rows != *rows)) {
    throw std::runtime_error("dataset " + std::string(name) + " has " + std::to_string(shape.rows) +
                             " rows of " + std::to_string(shape.columns) +
                             " values, it must have " + (rows ? std::to_string(*rows) + ' ' : "") +
                             "rows of 1 value");
  }
  return shape.rows;
}

}  // namespace

std::int64_t read_version(hid_t file) {
  const std::optional<std::int64_t> version = read_number(file, attribute::version);
  if (version != layout_version && version != layout_version_of_joints) {
    throw std::runtime_error("has a layout of version " +
                             (version ? std::to_string(*version) : "none") + ", known are " +
                             std::to_string(layout_version) + " and " +
                             std::to_string(layout_version_of_joints));
  }
  return *version;
}

FiberData::FiberData(hid_t frame)
    : has_joints_(read_version(frame) >= layout_version_of_joints),
      vtk_(open_group(frame, layout::vtk)),
      points_(open_dataset(vtk_.get(), layout::points)),
      offsets_(open_dataset(vtk_.get(), layout::offsets)),
      radii_(open_at(layout::at_points, layout::radius)),
      fibers_(open_at(layout::at_cells, layout::fiber)),
      first_segments_(open_at(layout::at_cells, layout::first_segment)),
      joints_(open_if(has_joints_, layout::at_points, layout::joint)),
      closed_(open_if(has_joints_, layout::at_cells, layout::closed)),
      joint_tolerance_(has_joints_ ? read_real(frame, attribute::joint_tolerance) : std::nullopt) {
  const Hdf5Shape points = shape_of(points_.get());
  if (points.columns != 3) {
    throw std::runtime_error("dataset Points has " + std::to_string(points.columns) +
                             " columns, it must have 3");
  }
  all_ = {require_rows(fibers_, layout::fiber, std::nullopt), points.rows};
  require_rows(radii_, layout::radius, all_.points);
  require_rows(first_segments_, layout::first_segment, all_.lines);
  if (has_joints_) {
    require_rows(*joints_, layout::joint, all_.points);
    require_rows(*closed_, layout::closed, all_.lines);
    FiberGraph::require_tolerance(joint_tolerance_);
  }
  require_rows(offsets_, layout::offsets, all_.lines + 1);
  if (offset(0) != 0 || offset(all_.lines) != all_.points) {
    throw std::runtime_error("Offsets begin with " + std::to_string(offset(0)) + " and end with " +
                             std::to_string(offset(all_.lines)) + ", they must with 0 and " +
                             std::to_string(all_.points) + ", as there are points");
  }
  if (all_.points < 2 * all_.lines) {
    throw std::runtime_error(std::to_string(all_.points) + " points for " +
                             std::to_string(all_.lines) + " lines, each must have two or more");
  }
}

FileSegment FiberData::find(std::uint64_t before) const {
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

Hdf5Id FiberData::open_at(const char* group, const char* name) const {
  const Hdf5Id place = open_group(vtk_.get(), group);
  return open_dataset(place.get(), name);
}

std::optional<Hdf5Id> FiberData::open_if(bool is_there, const char* group, const char* name) const {
  return is_there ? std::optional(open_at(group, name)) : std::nullopt;
}

std::uint64_t FiberData::offset(std::uint64_t line) const {
  return read_values<std::uint64_t>(offsets_.get(), line, 1).front();
}

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

std::vector<double> FiberData::radii_of(std::uint64_t first, std::uint64_t count) const {
  std::vector<double> radii = read_values<double>(radii_.get(), first, count);
  for (std::uint64_t i = 0; i < count; ++i) {
    if (!FiberAssembly::is_valid_radius(radii[i])) {
      throw std::runtime_error("point " + std::to_string(first + i) + " has the radius " +
                               fiber::text_of(radii[i]) + ", " + FiberAssembly::radius_rule);
    }
  }
  return radii;
}

std::vector<std::int32_t> FiberData::joints_of(std::uint64_t first, std::uint64_t count) const {
  if (!joints_) {
    return {};
  }
  std::vector<std::int32_t> joints;
  joints.reserve(count);
  for (const std::int64_t joint : read_values<std::int64_t>(joints_->get(), first, count)) {
    if (joint < -1 || joint > std::numeric_limits<std::int32_t>::max()) {
      throw std::runtime_error("point " + std::to_string(first + joints.size()) +
                               " has the joint " + std::to_string(joint) +
                               ", joints are numbers from 0 to 2147483647, -1 for none");
    }
    joints.push_back(static_cast<std::int32_t>(joint));
  }
  return joints;
}

std::vector<std::uint8_t> FiberData::closed_of(std::uint64_t begin, std::uint64_t end) const {
  if (!closed_) {
    return {};
  }
  auto closed = read_values<std::uint8_t>(closed_->get(), begin, end - begin);
  for (std::size_t i = 0; i < closed.size(); ++i) {
    if (closed[i] > 1) {
      throw std::runtime_error("line " + std::to_string(begin + i) + " has closed " +
                               std::to_string(closed[i]) + ", it must be 0 or 1");
    }
  }
  return closed;
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
  fibers.parts = FiberAssembly(points_of(begin.point, count), std::move(local),
                               shared_if_equal(radii_of(begin.point, count)));
  fibers.topology = {closed_of(begin.line, end_line), joints_of(begin.point, count),
                     joint_tolerance_};
  return fibers;
}

}  // namespace fiber
