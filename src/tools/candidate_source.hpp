#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/work_queue.hpp"

namespace fiber {

/// The frames of a file of fibres, each whole on the rank that wants it: of one of HDF5 that rank
/// reads it, any other file rank 0 has, and packs frames for others. pack() and take() are not
/// collective.
class CandidateSource {
 public:
  /// @param radius [m] of all fibres, if the file has no radii
  /// @throws std::invalid_argument on all ranks
  CandidateSource(const Communicator& ranks, const std::string& path, double radius);

  bool has_frames() const { return has_frames_; }
  std::uint64_t frame_count() const { return frame_count_; }

  /// Whether other ranks need frames packed.
  bool is_packed() const { return !reader_; }

  /// On rank 0, of frames that no rank has taken yet.
  std::vector<char> pack(const WorkRange& range);

  /// The frames of a range, in their order.
  /// @param packed what pack() has made for them; nothing on rank 0
  /// @throws std::invalid_argument naming the frame that is no valid one
  std::vector<FiberFrame> take(const WorkRange& range, const std::vector<char>& packed);

  /// A frame for every rank. Collective.
  /// @throws std::invalid_argument on all ranks, also if there is no such frame
  FiberFrame take_on_all(const Communicator& ranks, std::uint64_t index);

 private:
  FiberFrame read(std::uint64_t index) const;

  const std::string path_;
  const bool is_first_rank_;
  const Communicator alone_;                      // this rank
  std::optional<DistributedFiberReader> reader_;  // for HDF5
  FiberFile file_;                                // of rank 0, otherwise
  bool has_frames_ = false;
  std::uint64_t frame_count_ = 0;
};

}  // namespace fiber
