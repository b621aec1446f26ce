#include "src/hierarchy/segment_boxes.hpp"

#include "src/hierarchy/fiber_order.hpp"

namespace fiber {

void SegmentBoxes::reset(const FiberAssembly& fibers) {
  points_ = end_point_connected_order(fibers.offsets());
  boxes_.resize(points_.size());
}

void SegmentBoxes::fit(const FiberAssembly& fibers, std::size_t begin, std::size_t end) {
  // The libraries compute volumes in single precision, where those of boxes beyond the planets
  // would be infinite. Boxes that overlap still do when both are clamped.
  constexpr float limit = 1e12F;  // [m]
  constexpr Float4 lowest{-limit, -limit, -limit, -limit};
  constexpr Float4 highest{limit, limit, limit, limit};
  for (std::size_t i = begin; i < end; ++i) {
    Capsule capsule = fibers.capsule(points_[i]);
    capsule.p0 -= fibers.points().front();
    capsule.p1 -= fibers.points().front();
    capsule.radius += 0.5 * margin_;
    Aabb& box = boxes_[i];
    fiber::fit(box, capsule, {});
    box.lower = min(max(box.lower, lowest), highest);
    box.upper = min(max(box.upper, lowest), highest);
  }
}

void SegmentBoxes::update(const FiberAssembly& fibers, bool same_topology) {
  if (!same_topology) {
    reset(fibers);
  }
  fit(fibers, 0, size());
}

}  // namespace fiber
