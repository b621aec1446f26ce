#pragma once

#include <hdf5.h>

#include <cstddef>
#include <cstdint>
#include <functional>
#include <set>
#include <string>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/frame_datasets.hpp"
#include "src/mpi/partial_file.hpp"

namespace fiber {

/// Attributes that the root of each of our files has.
namespace attribute {
constexpr const char* content = "fiber_proximity";  // "fibers" or "contacts"
constexpr const char* version = "version";
constexpr const char* has_frames = "has_frames";
constexpr const char* frame = "frame";
constexpr const char* run = "run";
constexpr const char* joint_tolerance = "joint_tolerance";
}  // namespace attribute

constexpr std::int64_t layout_version = 1;
/// Files with closed or joined fibres have this version, so that programs that know of none refuse
/// them.
constexpr std::int64_t layout_version_of_joints = 2;

/// The facts of a frame, beside its data.
struct FrameFacts {
  std::int64_t number = 0;
  std::int64_t version = layout_version;
  std::uint64_t data_size = 0;  ///< [byte] of all its datasets together
};

/// Name of a frame by its index, within `frames` of NAME.h5 and in the folder NAME.frames.
std::string frame_name(std::size_t index);

/// One file, or one per frame and one with links to them; see distributed_files.hpp. All functions
/// but done() are collective.
class FrameFiles {
 public:
  /// @param content what is in them
  /// @throws std::invalid_argument
  FrameFiles(const Communicator& ranks, const std::string& path, std::string content,
             DistributedFileOptions options);

  std::size_t done() const { return done_; }

  /// Writes the next frame.
  /// @param make makes all groups, attributes and datasets on all ranks alike
  /// @throws std::invalid_argument
  void write(const FrameFacts& facts,
             const std::function<void(hid_t file, FrameDatasets& datasets)>& make);

  /// @throws std::invalid_argument
  void finish();

 private:
  std::string folder() const;
  std::string path_of(std::size_t index) const;
  void begin_anew() const;
  std::size_t count_done();
  bool is_of_this_run(const std::string& path);
  void write_attributes(hid_t file, std::int64_t version) const;
  void write_links() const;

  const Communicator& ranks_;
  const std::string path_;
  const std::string content_;
  const DistributedFileOptions options_;
  std::size_t done_ = 0;
  std::set<std::int64_t> frames_;              // numbers of those that are done
  std::int64_t max_version_ = layout_version;  // of those, on rank 0
};

struct DistributedFileWriter::State {
  State(MPI_Comm comm, const std::string& path, const char* content,
        const DistributedFileOptions& options)
      : ranks(comm), files(ranks, path, content, options) {}

  Communicator ranks;
  FrameFiles files;
};

}  // namespace fiber
