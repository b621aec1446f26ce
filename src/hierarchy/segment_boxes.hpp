#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/bounds/aabb.hpp"

namespace fiber {

/// The box of every segment, for broad phases of other libraries: relative to the first point of
/// all and thicker by half the margin, so that two overlap where the segments are no further apart
/// than it; in single precision, rounded outward as those of our own engines, and clamped to
/// 1e12 m.
class FIBER_PROXIMITY_EXPORT SegmentBoxes {
 public:
  /// @param margin [m] finite, >= 0
  explicit SegmentBoxes(double margin) : margin_(margin) {}

  /// Makes room for a box per segment of these fibres; to be fitted next.
  void reset(const FiberAssembly& fibers);

  /// Fits the boxes with indices from begin to before end. Several ranges may be fitted at once.
  void fit(const FiberAssembly& fibers, std::size_t begin, std::size_t end);

  /// Fits all boxes to moved points, or to other fibres.
  void update(const FiberAssembly& fibers, bool same_topology);

  std::size_t size() const { return boxes_.size(); }
  const Aabb& operator[](std::size_t index) const { return boxes_[index]; }

  /// First points of the segments, in the order of the boxes.
  const std::vector<std::uint32_t>& points() const { return points_; }

 private:
  double margin_;
  std::vector<Aabb> boxes_;
  std::vector<std::uint32_t> points_;
};

}  // namespace fiber
