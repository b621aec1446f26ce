#pragma once

#include <cstddef>
#include <fstream>
#include <stdexcept>
#include <string>

#include "fiber_proximity/export.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// A file that cannot be read or written, or does not hold what it should; the message names the
/// file, the line where there is one, and the reason.
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& name, const std::string& reason);
  FileError(const std::string& name, std::size_t line, const std::string& reason);

  /// With the system's reason (errno) after what failed.
  static FileError from_system(const std::string& name, const std::string& what);

  /// The system's reason (errno); 0 where it is not the system that refuses.
  int code() const noexcept { return code_; }

 private:
  int code_ = 0;
};

/// A file that is written.
class OutputFile {
 public:
  /// Opens the file; its former content is gone.
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
