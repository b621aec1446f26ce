#pragma once

#include <cstdint>

#include "src/mpi/named_fibers.hpp"

namespace fiber {

/// What segments are called, which come in any order.
class SegmentNames {
 public:
  explicit SegmentNames(const NamedFibers& fibers) : fibers_(fibers) {}

  /// What the segment that starts at this point is called by all ranks.
  GlobalSegment name_of(std::uint32_t point) {
    seek(point);
    return fibers_.name_of(stretch_, point - begin_);
  }
  /// The fibre here that it is on.
  std::uint32_t stretch_of(std::uint32_t point) {
    seek(point);
    return stretch_;
  }

 private:
  void seek(std::uint32_t point) {
    if (point - begin_ >= end_ - begin_) {
      stretch_ = fibers_.fibers().segment_id(point).fiber;
      begin_ = fibers_.fibers().offsets()[stretch_];
      end_ = fibers_.fibers().offsets()[stretch_ + 1];
    }
  }

  const NamedFibers& fibers_;
  std::uint32_t stretch_ = 0;  // that of the segment before, as the next one is often on it, too
  std::uint32_t begin_ = 0;    // of its points; none yet
  std::uint32_t end_ = 0;
};

}  // namespace fiber
