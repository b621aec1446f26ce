#pragma once

#include <sstream>
#include <stdexcept>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/fuzz/fuzz_target.hpp"

namespace fiber::test {

using Read = FiberFile(std::istream& stream, const std::string& name, const ReadOptions& options);
using Write = void(std::ostream& stream, const FiberFile& file);

/// The bytes of a file that are read as it; nothing if it cannot hold the numbers.
inline std::string written(Write& write, const FiberFile& file) {
  std::ostringstream stream;
  try {
    write(stream, file);
  } catch (const std::invalid_argument&) {
    return "";
  }
  return stream.str();
}

/// Sees that a file that was read is written, and read and written again as the same bytes.
inline void check_written(Read& read, Write& write, const FiberFile& file) {
  const std::string first = written(write, file);
  if (first.empty()) {
    return;
  }
  std::istringstream stream(first);
  if (written(write, read(stream, "written", {})) != first) {
    finding("a file that is not read as it was written");
  }
}

/// Reads a file of a format, with and without fibres of one point.
/// @param write nullptr for a format that is not written
/// @param multiple of the size of the input that may be in use [byte]
inline int fuzz_format(Read& read, Write* write, const std::uint8_t* data, std::size_t size,
                       std::size_t multiple = 200) {
  const Bounds bounds(times(multiple, size));
  for (const bool skips : {false, true}) {
    ReadOptions options(0.01);
    options.skip_single_points = skips;
    std::istringstream stream(text_of(data, size));
    try {
      const FiberFile file = read(stream, "fuzz", options);
      for (const std::string& note : file.notes) {
        check_error(std::runtime_error(note));
      }
      if (write != nullptr) {
        check_written(read, *write, file);
      }
    } catch (const FileError& error) {
      check_error(error);
    }
  }
  return 0;
}

}  // namespace fiber::test
