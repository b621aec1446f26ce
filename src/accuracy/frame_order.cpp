#include "src/accuracy/frame_order.hpp"

#include <algorithm>

namespace fiber {
namespace {

/// Frames of a block: what was found in one frame helps in the next with a skin, and this many in a
/// row show it.
constexpr std::size_t block_size = 20;

/// The bits of a number in reverse: 0, 1/2, 1/4, 3/4, 1/8, … of a power of two.
std::size_t reversed(std::size_t number, std::size_t power_of_two) {
  std::size_t result = 0;
  for (std::size_t bit = 1; bit < power_of_two; bit *= 2) {
    result = 2 * result + (number & bit ? 1 : 0);
  }
  return result;
}

}  // namespace

std::vector<FrameBlock> spread_blocks(std::size_t count) {
  const std::size_t block_count = (count + block_size - 1) / block_size;
  std::size_t power_of_two = 1;
  while (power_of_two < block_count) {
    power_of_two *= 2;
  }
  std::vector<FrameBlock> blocks;
  for (std::size_t i = 0; i < power_of_two; ++i) {
    const std::size_t block = reversed(i, power_of_two);
    if (block < block_count) {
      blocks.push_back({block * block_size, std::min((block + 1) * block_size, count)});
    }
  }
  return blocks;
}

}  // namespace fiber
