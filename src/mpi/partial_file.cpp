#include "src/mpi/partial_file.hpp"

#include <fcntl.h>
#include <unistd.h>

#include <cerrno>
#include <filesystem>
#include <system_error>
#include <vector>

#include "fiber_proximity/io/file.hpp"

namespace fiber {
namespace {

/// Has the system do something with a file.
/// @param work returns whether it went well, else there is errno
/// @throws FileError
template <class Work>
void with_file(const std::string& path, int flags, const Work& work) {
  const int file = open(path.c_str(), flags | O_CLOEXEC);
  if (file < 0) {
    throw FileError::from_system(path, "cannot be written");
  }
  const bool went_well = work(file);
  const int error = errno;
  close(file);
  if (!went_well) {
    errno = error;
    throw FileError::from_system(path, "cannot be written");
  }
}

WritePlace place_of_name(const std::string& path) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  if (fs::is_directory(status)) {
    throw FileError(path, "cannot be written: is a folder");
  }
  if (fs::exists(status) && !fs::is_regular_file(status)) {
    return {path, false};
  }
  constexpr int max_links = 40;  // as systems allow
  fs::path place(path);
  for (int links = 0; fs::is_symlink(fs::symlink_status(place, error)); ++links) {
    if (links == max_links) {
      throw FileError(path, "cannot be written: too many links");
    }
    place = place.parent_path() / fs::read_symlink(place);  // an absolute one replaces all
  }
  return {place.string(), true};
}

}  // namespace

WritePlace write_place(const Communicator& ranks, const std::string& path) {
  WritePlace place;
  run_on_root(ranks, [&] { place = place_of_name(path); });
  const std::vector<char> text =
      ranks.broadcast(std::vector<char>(place.path.begin(), place.path.end()));
  return {{text.begin(), text.end()}, ranks.broadcast(place.is_file)};
}

void reserve(const std::string& path, std::uint64_t size) {
  with_file(path, O_WRONLY, [size](int file) {
    int result = 0;
    do {
      result = size == 0 ? 0 : fallocate(file, 0, 0, static_cast<off_t>(size));
    } while (result != 0 && errno == EINTR);
    return result == 0 || (errno != ENOSPC && errno != EFBIG && errno != EDQUOT);
  });
}

void move_into_place(const std::string& path) {
  // A device or a pipe has no disk to wait for.
  with_file(partial_name(path), O_RDONLY,
            [](int file) { return fsync(file) == 0 || errno == EINVAL || errno == EROFS; });
  std::error_code error;
  std::filesystem::rename(partial_name(path), path, error);
  if (error) {
    throw FileError(path, "cannot be written: " + error.message());
  }
}

void remove_partial(const std::string& path) {
  std::error_code ignored;
  std::filesystem::remove(partial_name(path), ignored);
}

}  // namespace fiber
