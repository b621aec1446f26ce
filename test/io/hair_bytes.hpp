#pragma once

#include <cstdint>
#include <sstream>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "test/io/format.hpp"

namespace fiber::test {

using Offsets = std::vector<std::uint32_t>;
using Radii = std::vector<double>;

inline FiberFile parse(const std::string& text, double default_radius = 0.0) {
  std::istringstream stream(text);
  return read_hair(stream, "a.hair", default_radius);
}

inline FiberAssembly fibers_of(const std::string& text, double default_radius = 0.0) {
  return parse(text, default_radius).frames.at(0).fibers;
}

}  // namespace fiber::test
