#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"

namespace fiber {

/// Fibres of a file, for all ranks: of one of HDF5 each reads its part, any other one rank 0 reads.
/// All functions are collective.
class FiberSource {
 public:
  /// @param radius [m] of all fibres, if the file has no radii
  /// @throws std::invalid_argument on all ranks
  FiberSource(const Communicator& ranks, const std::string& path, double radius);

  bool has_frames() const { return has_frames_; }
  std::size_t frame_count() const { return frame_count_; }

  /// This rank's part of a frame, which is read once.
  /// @return the frame's number, if frames have one
  /// @throws std::invalid_argument on all ranks
  std::int64_t read(std::size_t index, DistributedFibers& fibers);

 private:
  const Communicator& ranks_;
  std::optional<DistributedFiberReader> reader_;  // for HDF5
  FiberFile file_;                                // of rank 0, otherwise
  bool has_frames_ = false;
  std::size_t frame_count_ = 0;
};

/// What tells a file from others, and from itself before a change: for DistributedFileOptions::run.
/// @throws std::invalid_argument on all ranks
std::string description_of_file(const Communicator& ranks, const std::string& path);

}  // namespace fiber
