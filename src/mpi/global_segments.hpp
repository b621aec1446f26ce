#pragma once

#include <cstdint>
#include <vector>

#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// Global ids of segments by the points that they start at: a table for whoever asks for each pair
/// there is, in any order.
class GlobalSegments {
 public:
  GlobalSegments() = default;
  explicit GlobalSegments(const LocalFibers& fibers) : fibers_(&fibers) {
    const std::vector<std::uint32_t>& offsets = fibers.fibers().offsets();
    stretches_.reserve(fibers.fibers().point_count());
    for (std::uint32_t stretch = 0; stretch + 1 < offsets.size(); ++stretch) {
      stretches_.resize(offsets[stretch + 1], stretch);
    }
  }

  GlobalSegment global_id(std::uint32_t point) const {
    const std::uint32_t stretch = stretches_[point];
    return fibers_->global_id(stretch, point - fibers_->fibers().offsets()[stretch]);
  }

  /// The fibre here that a segment is on.
  std::uint32_t stretch_of(std::uint32_t point) const { return stretches_[point]; }

 private:
  const LocalFibers* fibers_ = nullptr;
  std::vector<std::uint32_t> stretches_;  // by point
};

}  // namespace fiber
