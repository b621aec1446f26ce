#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"

namespace fiber {

/// Which fibres of a frame are in the next one, wherever they stand there: those of the same name
/// that have as many points.
struct FiberMatch {
  std::vector<std::uint32_t> before;  ///< their indices, in order
  std::vector<std::uint32_t> after;   ///< what the same fibres have in the next frame
  std::vector<std::uint32_t>
      others;  ///< the rest of the frame, whose motion is not known, in order

  /// Tells on one line what else is different; "" if nothing is.
  std::string difference;

  bool is_other(std::uint64_t fiber) const {
    return std::binary_search(others.begin(), others.end(), fiber);
  }
};

FiberMatch match_fibers(const FiberFrame& from, const FiberFrame& to);

/// Whether these are 0, 1, 2, … below a number.
bool is_all(const std::vector<std::uint32_t>& fibers, std::size_t count);

}  // namespace fiber
