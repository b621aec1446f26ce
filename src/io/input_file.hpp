#pragma once

#include <cerrno>
#include <fstream>
#include <string>
#include <string_view>

#include "fiber_proximity/io/file_error.hpp"

namespace fiber {

/// @throws FileError
inline std::ifstream open_to_read(const std::string& path) {
  errno = 0;
  std::ifstream stream(path, std::ios::binary);
  if (!stream) {
    throw FileError::from_system(path, "cannot be opened");
  }
  return stream;
}

/// Calls take(line) with each line, the first without the byte order mark that spreadsheets write.
/// @throws FileError that calls the stream by `name`
template <class Take>
void for_each_line(std::istream& stream, const std::string& name, const Take& take) {
  constexpr std::string_view mark = "\xEF\xBB\xBF";
  std::string line;
  bool first = true;
  errno = 0;
  while (std::getline(stream, line)) {
    const bool marked = first && line.compare(0, mark.size(), mark) == 0;
    first = false;
    take(std::string_view(line).substr(marked ? mark.size() : 0));
  }
  if (stream.bad()) {
    throw FileError::from_system(name, "cannot be read");
  }
}

}  // namespace fiber
