#pragma once

#include <fstream>
#include <string>

#include "fiber_proximity/io/file_error.hpp"

namespace fiber {

/// A file that is written.
class OutputFile {
 public:
  /// What the file held is gone.
  /// @throws FileError
  explicit OutputFile(const std::string& path);

  /// To write to, which is not checked for errors.
  std::ostream& stream() { return stream_; }

  /// @throws FileError if anything that was written so far has failed
  void check() const;

  /// @throws FileError
  void write(const std::string& text);

  /// Call once, at the end: only then is all of it in the file.
  /// @throws FileError
  void close();

 private:
  std::string path_;
  std::ofstream stream_;
};

}  // namespace fiber
