#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fiber_proximity/io/file.hpp"
#include "fiber_proximity/mpi/distributed_files.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/partial_file.hpp"
#include "src/tools/checkpoint_file.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

/// Text that all ranks write, those with smaller numbers first. A file gets its name once it is
/// whole, and each rank writes to it at its place. To what is no file, as a pipe or the stdout of
/// rank 0, all text passes through rank 0. All functions are collective.
///
/// Rank 0 writes while it makes its text. The others keep theirs until they know how long the texts
/// before it are.
class ParallelTextFile {
 public:
  /// @param path    "" for stdout
  /// @param options the run, if checkpoint() is called, and whether to go on with an earlier one
  /// @throws std::invalid_argument on all ranks
  ParallelTextFile(const Communicator& ranks, const std::string& path,
                   const DistributedFileOptions& options = {});
  ~ParallelTextFile();
  ParallelTextFile(const ParallelTextFile&) = delete;
  ParallelTextFile& operator=(const ParallelTextFile&) = delete;

  /// Appends what each rank writes.
  /// @throws std::invalid_argument on all ranks
  void append(const std::function<void(TextOutput& output)>& write);

  /// How many steps of the work the text of an earlier run holds.
  std::uint64_t done() const { return progress_.steps; }

  /// Records how many steps of the work the text holds: a run that is killed after this can be gone
  /// on with from there. Does nothing for what is no file.
  /// @throws std::invalid_argument on all ranks
  void checkpoint(std::uint64_t steps);

  /// Call once, at the end: only then the file has its name.
  /// @throws std::invalid_argument on all ranks
  void finish();

 private:
  RunProgress begin(bool resume) const;
  std::ostream& stream();
  void write_to_stream(std::string_view text);
  void write_to_file(std::uint64_t place, std::string_view text) const;
  void send_to_root(const std::vector<std::string>& pieces) const;
  std::string receive_from(int rank, std::uint64_t size);
  void close_file();
  void remove_unfinished() const;

  const Communicator& ranks_;
  const WritePlace place_;
  const std::string path_;
  const CheckpointFile checkpoint_;
  std::optional<OutputFile> stream_;  // of rank 0, for what is no file; none for stdout
  int file_ = -1;                     // of each rank, where there is a file
  RunProgress progress_;
};

}  // namespace fiber
