#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// The fibres at one moment of a recording.
struct FiberFrame {
  std::int64_t frame = 0;  ///< the frame's number in the file
  FiberAssembly fibers;
};

/// What a fibre file holds: one frame without a number, or any number of numbered ones.
struct FiberFile {
  bool has_frames = false;
  std::vector<FiberFrame> frames;  ///< in the file's order; exactly one without numbers
};

}  // namespace fiber
