#pragma once

#include <cstddef>
#include <vector>

namespace fiber {

/// A few frames in a row.
struct FrameBlock {
  std::size_t begin = 0;
  std::size_t end = 0;
};

/// All frames in blocks of some in a row, in an order in which any number of the first blocks is
/// spread over the whole recording: whoever runs out of time has seen all of it a little.
/// @param count of frames
std::vector<FrameBlock> spread_blocks(std::size_t count);

}  // namespace fiber
