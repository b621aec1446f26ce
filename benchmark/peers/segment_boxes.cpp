#include "peers/segment_boxes.hpp"

#include "fiber_proximity/hierarchy/fiber_order.hpp"

namespace fiber {

Capsule peer_capsule(const FiberAssembly& fibers, std::uint32_t point, double margin) {
  const std::vector<Eigen::Vector3d>& points = fibers.points();
  return {points[point] - points.front(), points[point + 1] - points.front(),
          fibers.segment_radius(point) + 0.5 * margin};
}

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
    Aabb& box = boxes_[i];
    fiber::fit(box, peer_capsule(fibers, points_[i], margin_), {});
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
