#include "src/ros/inputs/closed_fibers.hpp"

#include <algorithm>
#include <set>
#include <utility>

namespace fiber_proximity_ros {
namespace {

/// Takes points of a buffer over into a new one, fibre by fibre.
class BufferCopy {
 public:
  explicit BufferCopy(FiberBuffer& fibers)
      : fibers_(fibers), has_radius_per_point_(fibers.has_radius_per_point()) {
    topology_.closed.reserve(fibers.fiber_count());
  }

  void add_point(std::uint32_t point) {
    points_.push_back(fibers_.points[point]);
    if (has_radius_per_point_) {
      radii_.push_back(fibers_.radii[point]);
    }
    if (!fibers_.topology.joints.empty()) {
      topology_.joints.push_back(fibers_.topology.joints[point]);
    }
  }

  void end_fiber(bool is_closed) {
    offsets_.push_back(static_cast<std::uint32_t>(points_.size()));
    topology_.closed.push_back(is_closed ? 1 : 0);
  }

  std::vector<std::int32_t>& joints() { return topology_.joints; }
  std::size_t point_count() const { return points_.size(); }

  void finish() {
    fibers_.points = std::move(points_);
    fibers_.offsets = std::move(offsets_);
    fibers_.topology = std::move(topology_);
    if (has_radius_per_point_) {
      fibers_.radii = std::move(radii_);
    }
  }

 private:
  FiberBuffer& fibers_;
  const bool has_radius_per_point_;
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> offsets_{0};
  std::vector<double> radii_;
  fiber::FiberTopology topology_;
};

bool is_ring(const FiberBuffer& fibers, std::size_t fiber) {
  constexpr std::uint32_t min_points = 4;  // three, and the first one again
  const std::uint32_t begin = fibers.offsets[fiber];
  const std::uint32_t end = fibers.offsets[fiber + 1];
  return !fibers.is_closed(fiber) && end - begin >= min_points &&
         fibers.points[begin] == fibers.points[end - 1];
}

}  // namespace

bool has_sound_layout(const FiberBuffer& fibers) {
  const std::vector<std::uint32_t>& offsets = fibers.offsets;
  const auto is_too_short = [](std::uint32_t begin, std::uint32_t end) {
    return std::uint64_t{end} < std::uint64_t{begin} + 2;
  };
  const std::size_t radii = fibers.radii.size();
  const std::size_t closed = fibers.topology.closed.size();
  const std::size_t joints = fibers.topology.joints.size();
  return !offsets.empty() && offsets.front() == 0 && offsets.back() == fibers.points.size() &&
         std::adjacent_find(offsets.begin(), offsets.end(), is_too_short) == offsets.end() &&
         (radii <= 1 || radii == fibers.fiber_count() || radii == fibers.points.size()) &&
         (closed == 0 || closed == fibers.fiber_count()) &&
         (joints == 0 || joints == fibers.points.size());
}

void close_rings(FiberBuffer& fibers) {
  if (!has_sound_layout(fibers)) {
    return;
  }
  bool is_any_ring = false;
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    is_any_ring = is_any_ring || is_ring(fibers, fiber);
  }
  if (!is_any_ring) {
    return;
  }
  BufferCopy copy(fibers);
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const bool closes = is_ring(fibers, fiber);
    const std::uint32_t end = fibers.offsets[fiber + 1] - (closes ? 1 : 0);
    for (std::uint32_t point = fibers.offsets[fiber]; point < end; ++point) {
      copy.add_point(point);
    }
    copy.end_fiber(closes || fibers.is_closed(fiber));
  }
  copy.finish();
}

void open_rings(FiberBuffer& fibers) {
  std::vector<std::int32_t>& joints = fibers.topology.joints;
  if (joints.empty()) {
    joints.assign(fibers.points.size(), -1);
  }
  const std::set<std::int32_t> taken(joints.begin(), joints.end());
  std::int32_t unused = 0;
  BufferCopy copy(fibers);
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::uint32_t begin = fibers.offsets[fiber];
    const std::size_t new_begin = copy.point_count();
    for (std::uint32_t point = begin; point < fibers.offsets[fiber + 1]; ++point) {
      copy.add_point(point);
    }
    if (fibers.is_closed(fiber)) {
      if (joints[begin] < 0) {
        while (taken.count(unused) != 0) {
          ++unused;
        }
        copy.joints()[new_begin] = joints[begin] = unused++;
      }
      copy.add_point(begin);
    }
    copy.end_fiber(false);
  }
  copy.finish();
}

}  // namespace fiber_proximity_ros
