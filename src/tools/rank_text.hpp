#pragma once

#include <mpi.h>

#include <cstdint>
#include <functional>
#include <optional>
#include <ostream>
#include <string>

#include "fiber_proximity/io/file.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/partial_file.hpp"
#include "src/tools/run_note.hpp"
#include "src/tools/text_output.hpp"

namespace fiber {

/// What a RankText is made of.
struct TextRun {
  std::string run;      ///< all that the text depends on, on one line, if note() is called
  bool resume = false;  ///< whether to go on with what an earlier one has noted
};

/// Text that all ranks write, those with smaller numbers first: to a file, each rank at its place,
/// which has its name once it is whole; or to what is no file, as a pipe, or the stdout of rank 0,
/// through which it passes piece by piece. All functions are collective.
class RankText {
 public:
  /// @param path "" for stdout
  /// @param run  of what is no file nothing is noted
  /// @throws std::invalid_argument on all ranks
  RankText(const Communicator& ranks, const std::string& path, const TextRun& run = {});
  ~RankText();
  RankText(const RankText&) = delete;
  RankText& operator=(const RankText&) = delete;

  /// Appends what each rank writes.
  /// @param write may be called twice, and must write the same then
  /// @throws std::invalid_argument on all ranks
  void append(const std::function<void(TextOutput& output)>& write);

  /// How many steps of the work an earlier run has noted; their text is there.
  std::uint64_t done() const { return done_; }

  /// Notes how many steps of the work what has been appended is: a run that is killed now goes on
  /// there.
  /// @throws std::invalid_argument on all ranks
  void note(std::uint64_t steps);

  /// Call once, at the end: only then the file has its name.
  /// @throws std::invalid_argument on all ranks
  void finish();

 private:
  void append_to_file(const std::function<void(TextOutput& output)>& write);
  void append_to_stream(const std::function<void(TextOutput& output)>& write);
  void pass_on_others(std::ostream& stream) const;
  std::string failure_of_stream() const;
  RunProgress begin(bool resume) const;
  void throw_on_all(const std::string& reason) const;
  std::string close_file();
  void remove_unfinished() const;

  const Communicator& ranks_;
  const WritePlace place_;
  const std::string path_;
  const RunNote note_;
  std::optional<OutputFile> stream_;  // of rank 0, for what is no file; none for stdout
  MPI_File file_ = MPI_FILE_NULL;
  std::uint64_t size_ = 0;  // [byte] of the file so far
  std::uint64_t done_ = 0;
};

}  // namespace fiber
