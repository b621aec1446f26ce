#pragma once

#include <hdf5.h>

#include <Eigen/Core>
#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/hdf5_file.hpp"

namespace fiber {

/// The version of the layout of one of our files.
/// @throws std::runtime_error for one that is not known
std::int64_t read_version(hid_t file);

/// A segment of the file: the line it is part of, and its first point.
struct FileSegment {
  std::uint64_t line = 0;
  std::uint64_t point = 0;
};

/// How many lines, parts of fibres, and how many points they have.
struct FiberCounts {
  std::uint64_t lines = 0;
  std::uint64_t points = 0;
};

/// The datasets of a frame, to read.
class FiberData {
 public:
  /// @throws std::runtime_error for datasets that do not go together
  explicit FiberData(hid_t frame);

  std::uint64_t segment_count() const { return all_.points - all_.lines; }

  /// Finds the segment that has so many before it. Offsets need not be right.
  FileSegment find(std::uint64_t before) const;

  /// The segments from one up to another.
  /// @throws std::runtime_error naming the place and value of what is wrong
  DistributedFibers read(const FileSegment& begin, const FileSegment& end) const;

 private:
  Hdf5Id open_at(const char* group, const char* name) const;
  std::optional<Hdf5Id> open_if(bool is_there, const char* group, const char* name) const;
  std::uint64_t offset(std::uint64_t line) const;
  std::vector<std::uint64_t> offsets_of(std::uint64_t begin, std::uint64_t end) const;
  std::vector<Eigen::Vector3d> points_of(std::uint64_t first, std::uint64_t count) const;
  std::vector<double> radii_of(std::uint64_t first, std::uint64_t count) const;
  std::vector<std::int32_t> joints_of(std::uint64_t first, std::uint64_t count) const;
  std::vector<std::uint8_t> closed_of(std::uint64_t begin, std::uint64_t end) const;

  const bool has_joints_;
  Hdf5Id vtk_;
  Hdf5Id points_;
  Hdf5Id offsets_;
  Hdf5Id radii_;
  Hdf5Id fibers_;
  Hdf5Id first_segments_;
  std::optional<Hdf5Id> joints_;  // these are in files of version 2
  std::optional<Hdf5Id> closed_;
  std::optional<double> joint_tolerance_;  // [m]
  FiberCounts all_;
};

}  // namespace fiber
