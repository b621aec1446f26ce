#pragma once

#include <cstdint>
#include <vector>

namespace fiber {

/// Which rods may touch each other in a step, directly or through others: disjoint sets of them, as
/// a forest whose roots are the least rods of their trees.
class Islands {
 public:
  /// Each rod is alone.
  void reset(std::uint32_t rods);

  /// Makes the islands of two rods one.
  void join(std::uint32_t a, std::uint32_t b);

  /// The least rod of a rod's island.
  std::uint32_t of(std::uint32_t rod) const;

 private:
  std::vector<std::uint32_t> parents_;  // by rod, never greater
};

}  // namespace fiber
