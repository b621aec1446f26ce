#pragma once

#include <cstddef>
#include <stdexcept>
#include <string>

namespace fiber {

/// A file that cannot be read or written, or does not hold what it should; the message names the
/// file, the line where there is one, and the reason.
class FileError : public std::runtime_error {
 public:
  FileError(const std::string& name, const std::string& reason);
  FileError(const std::string& name, std::size_t line, const std::string& reason);

  /// With the system's reason (errno) after what failed.
  static FileError from_system(const std::string& name, const std::string& what);
};

}  // namespace fiber
