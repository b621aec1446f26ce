#pragma once

#include <iostream>
#include <string>

#include "fiber_proximity/io/fiber_file.hpp"

namespace fiber {

/// Reads a fibre file, and tells on stderr what of it is not read.
/// @param tool that tells it
/// @throws as read_fibers()
inline FiberFile read_input(const char* tool, const std::string& path, const ReadOptions& reading) {
  FiberFile file = read_fibers(path, reading);
  for (const std::string& note : file.notes) {
    std::cerr << tool << ": " << path << ": " << note << '\n';
  }
  return file;
}

}  // namespace fiber
