#include "fiber_proximity/io/output_file.hpp"

#include <cerrno>

namespace fiber {

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
