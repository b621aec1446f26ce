#pragma once

#include <cstddef>
#include <optional>
#include <string>

#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/tools/parallel_text_file.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

enum class ContactFormat { CSV, JSON, HDF5 };

/// Where contacts of all ranks go.
struct ContactTarget {
  std::string path;  // "" for stdout
  ContactFormat format = ContactFormat::CSV;
};

/// Writes contacts frame by frame; each rank its part. All functions are collective.
class ContactSink {
 public:
  /// @throws std::invalid_argument on all ranks
  ContactSink(const Communicator& ranks, const ContactTarget& target,
              const DistributedFileOptions& options);

  /// How many frames an earlier run has written.
  std::size_t done() const { return hdf5_ ? hdf5_->done() : 0; }

  /// @param names  of the fibres, by number
  /// @param result is sorted over the ranks by this
  /// @throws std::invalid_argument on all ranks
  void write(const FrameNumber& frame, const FiberNames& names, DistributedResult& result);

  /// Call once, at the end.
  /// @throws std::invalid_argument on all ranks
  void finish();

 private:
  void write_json(const FrameNumber& frame, const FiberNames& names,
                  const DistributedResult& result);

  const Communicator& ranks_;
  const ContactFormat format_;
  std::optional<DistributedContactWriter> hdf5_;
  std::optional<ParallelTextFile> text_;  // one of the two
};

}  // namespace fiber
