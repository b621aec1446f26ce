#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/environment/allowed_pairs.hpp"
#include "fiber_proximity/environment/shapes.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// Pairs that may touch, sorted so that it is quickly known of a segment and an object.
class AllowedParts {
 public:
  AllowedParts(const AllowedPairs& allowed, const std::vector<EnvironmentObject>& objects);

  /// Whether this segment may touch the object of this index.
  bool holds(const FiberAssembly& fibers, SegmentId segment, std::uint32_t object) const;

 private:
  /// A part of a fibre that may touch an object: as AllowedPair has it.
  struct Part {
    std::uint32_t fiber;
    std::int64_t first_segment;
    std::int64_t last_segment;
  };
  struct OfFiber;

  // By object, behind them those of every object, each sorted by fibre; empty if there are none.
  std::vector<std::vector<Part>> parts_;
};

}  // namespace fiber
