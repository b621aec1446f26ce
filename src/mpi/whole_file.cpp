#include "src/mpi/whole_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>

#include "fiber_proximity/io/file.hpp"

namespace fiber {
namespace {

/// Waits until a file is on the disk.
/// @throws FileError
void settle(const std::string& path) {
  const int file = open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (file < 0) {
    throw FileError::from_system(path, "cannot be written");
  }
  // What is no file on a disk needs no waiting for it.
  const bool is_settled = fsync(file) == 0 || errno == EINVAL || errno == EROFS;
  const int error = errno;
  close(file);
  if (!is_settled) {
    errno = error;
    throw FileError::from_system(path, "cannot be written");
  }
}

}  // namespace

void move_into_place(const std::string& path) {
  settle(aside(path));
  std::error_code error;
  std::filesystem::rename(aside(path), path, error);
  if (error) {
    throw FileError(path, "cannot be written: " + error.message());
  }
}

void remove_aside(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(aside(path), ignored);
}

}  // namespace fiber
