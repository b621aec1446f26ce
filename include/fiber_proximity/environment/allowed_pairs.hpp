#pragma once

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace fiber {

/// An object and a part of a fibre that may touch, such as a gripper and the end it holds: they are
/// no pair.
struct AllowedPair {
  static constexpr std::uint32_t every_fiber = std::numeric_limits<std::uint32_t>::max();

  std::string object;  ///< name; empty for every one
  std::uint32_t fiber = every_fiber;
  /// Segments of that part, both included; negative ones count from the end, -1 is the last.
  std::int64_t first_segment = 0;
  std::int64_t last_segment = -1;
};

using AllowedPairs = std::vector<AllowedPair>;

}  // namespace fiber
