#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/work_queue.hpp"

namespace fiber {

/// How ranks share the frames of a file.
enum class FrameSharing {
  PARTS,  ///< each rank has a part of each frame
  WHOLE   ///< a frame is whole on the rank that takes it
};

/// The fibres of a file, for all ranks. HDF5 is read by each rank, any other file by rank 0, which
/// sends to the others what is theirs. Each frame is read once.
class FiberSource {
 public:
  /// Collective.
  /// @param reading how a file that is not HDF5 is read
  /// @throws std::invalid_argument on all ranks
  FiberSource(const Communicator& ranks, const std::string& path, const ReadOptions& reading,
              FrameSharing sharing);

  bool has_frames() const { return has_frames_; }
  std::size_t frame_count() const { return frame_count_; }

  /// Reads this rank's part of a frame, of PARTS. Collective.
  /// @return the frame's number, if frames have one
  /// @throws std::invalid_argument on all ranks
  std::int64_t read(std::size_t index, DistributedFibers& fibers);

  // These are for frames that are shared WHOLE.

  /// Whether other ranks need what pack() makes of a range to take its frames.
  bool is_packed() const { return !reader_; }

  /// Packs frames for another rank; on rank 0 only, where the frames are not left after this.
  std::vector<char> pack(const WorkRange& range);

  /// The frames of a range in their order, for this rank alone.
  /// @param packed from pack() on rank 0; not used on rank 0
  /// @throws std::invalid_argument naming the frame that is not valid
  std::vector<FiberFrame> take(const WorkRange& range, const std::vector<char>& packed);

  /// The first frame, for every rank. Collective.
  /// @throws std::invalid_argument on all ranks, also if there is no frame
  FiberFrame take_first_on_all();

 private:
  FiberFrame read_alone(std::uint64_t index) const;
  void tell_of_lonely_joints(std::int64_t number, const DistributedFibers& fibers);

  const Communicator& ranks_;
  const Communicator alone_;  // this rank
  const std::string path_;
  std::optional<DistributedFiberReader> reader_;  // for HDF5
  FiberFile file_;                                // of rank 0, otherwise
  bool has_frames_ = false;
  std::size_t frame_count_ = 0;
  bool is_lonely_told_ = false;  // of a joint in a file of HDF5
};

/// Tells a file from others, and from itself before a change, for DistributedFileOptions::run.
/// Collective.
/// @throws std::invalid_argument on all ranks
std::string description_of_file(const Communicator& ranks, const std::string& path);

}  // namespace fiber
