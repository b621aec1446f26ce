#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fiber {

/// How far a run has come: its file holds so many steps of the work in its first so many bytes.
struct RunProgress {
  std::uint64_t steps = 0;
  std::uint64_t bytes = 0;
};

/// Tells how far a file has come that has not got its name yet. It stands beside it as
/// FILE.part.run. A run that was killed goes on from there when it is started again. One rank calls
/// the functions.
class CheckpointFile {
 public:
  /// @param path of the file whose progress it tells
  /// @param run  all that the file depends on, on one line
  CheckpointFile(const std::string& path, std::string run);

  /// Nothing if one of the two files is not there.
  /// @throws FileError if it was written by another run or is damaged
  std::optional<RunProgress> read() const;

  /// @throws FileError
  void write(const RunProgress& progress) const;

  void remove() const;

 private:
  std::string part_;  // the file as it is called until it is whole
  std::string path_;
  std::string run_;
};

}  // namespace fiber
