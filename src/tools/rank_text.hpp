#pragma once

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <string>

#include "src/mpi/communicator.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

/// Text that all ranks write, those with smaller numbers first: to a file, each rank at its place,
/// which has its name once it is whole; or to the stdout of rank 0, through which it passes piece
/// by piece. All functions are collective.
class RankText {
 public:
  /// @param path "" for stdout
  /// @throws std::invalid_argument on all ranks
  RankText(const Communicator& ranks, std::string path);
  ~RankText();
  RankText(const RankText&) = delete;
  RankText& operator=(const RankText&) = delete;

  /// Appends what each rank writes.
  /// @param write may be called twice, and must write the same then
  /// @throws std::invalid_argument on all ranks
  void append(const std::function<void(TextOutput& output)>& write);

  /// Call once, at the end: only then the file has its name.
  /// @throws std::invalid_argument on all ranks
  void finish();

 private:
  void append_to_file(const std::function<void(TextOutput& output)>& write);
  void append_to_stdout(const std::function<void(TextOutput& output)>& write) const;
  void pass_on_others() const;
  std::string close_file();
  void remove_unfinished() const;

  const Communicator& ranks_;
  const std::string path_;
  MPI_File file_ = MPI_FILE_NULL;
  std::uint64_t size_ = 0;  // [byte] of the file so far
};

}  // namespace fiber
