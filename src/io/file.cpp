#include "fiber_proximity/io/file.hpp"

#include <cerrno>
#include <system_error>

#include "src/text/quote.hpp"

namespace fiber {
namespace {

// [byte] The longest path that systems allow: names stay whole.
constexpr std::size_t longest_name = 4096;

}  // namespace

FileError::FileError(const std::string& name, const std::string& reason)
    : std::runtime_error(shortened(name, longest_name) + ": " + reason) {}

FileError::FileError(const std::string& name, std::size_t line, const std::string& reason)
    : std::runtime_error(shortened(name, longest_name) + ":" + std::to_string(line) + ": " +
                         reason) {}

FileError FileError::from_system(const std::string& name, const std::string& what) {
  const int code = errno;
  FileError error(name, what + ": " + std::generic_category().message(code));
  error.code_ = code;
  return error;
}

OutputFile::OutputFile(const std::string& path) : path_(path) {
  errno = 0;
  stream_.open(path, std::ios::binary);
  if (!stream_) {
    throw FileError::from_system(path, "cannot be opened for writing");
  }
}

void OutputFile::check() const {
  if (!stream_) {
    throw FileError::from_system(path_, "cannot be written");
  }
}

void OutputFile::write(const std::string& text) {
  stream_ << text;
  check();
}

void OutputFile::close() {
  stream_.close();
  check();
}

}  // namespace fiber
