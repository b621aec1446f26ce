#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace fiber {

/// How far a file has come: so many steps of the work are in its first so many bytes.
struct RunProgress {
  std::uint64_t steps = 0;
  std::uint64_t bytes = 0;
};

/// A note beside a file that is written aside, FILE.part.run: a run that was killed goes on from
/// there when it is started again. By one rank.
class RunNote {
 public:
  /// @param path of the file
  /// @param run  all that the file depends on, on one line
  RunNote(const std::string& path, std::string run);

  /// Nothing if there is no such file or no note.
  /// @throws FileError where it is of another run
  std::optional<RunProgress> read() const;

  /// @throws FileError
  void write(const RunProgress& progress) const;

  void remove() const;

 private:
  std::string part_;  // the file as it is written
  std::string name_;
  std::string run_;
};

}  // namespace fiber
