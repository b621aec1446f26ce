#include "fiber_proximity/io/file_error.hpp"

#include <cerrno>
#include <system_error>

namespace fiber {

FileError::FileError(const std::string& name, const std::string& reason)
    : std::runtime_error(name + ": " + reason) {}

FileError::FileError(const std::string& name, std::size_t line, const std::string& reason)
    : std::runtime_error(name + ":" + std::to_string(line) + ": " + reason) {}

FileError FileError::from_system(const std::string& name, const std::string& what) {
  return {name, what + ": " + std::generic_category().message(errno)};
}

}  // namespace fiber
