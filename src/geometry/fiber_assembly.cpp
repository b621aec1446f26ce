#include "fiber_proximity/geometry/fiber_assembly.hpp"

#include <algorithm>
#include <cassert>
#include <limits>
#include <sstream>
#include <stdexcept>
#include <utility>

#include "src/geometry/fiber_graph.hpp"

namespace fiber {
namespace {

template <class... Parts>
[[noreturn]] void refuse(const Parts&... parts) {
  std::ostringstream message;
  (message << ... << parts);
  throw std::invalid_argument(message.str());
}

void check_offsets(const std::vector<std::uint32_t>& offsets, std::size_t point_count) {
  // The flag bit of BinaryTree's leaves halves the range of indices.
  constexpr std::size_t max_points = 0x8000'0000U;
  if (point_count >= max_points) {
    refuse(point_count, " points; at most ", max_points - 1, " are supported");
  }
  if (offsets.empty() || offsets.front() != 0) {
    refuse("offsets must start with 0", offsets.empty() ? ", but are empty" : ", not ",
           offsets.empty() ? std::string() : std::to_string(offsets.front()));
  }
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    const std::uint32_t begin = offsets[fiber];
    const std::uint32_t end = offsets[fiber + 1];
    if (end < begin) {
      refuse("fibre ", fiber, ": offsets decrease from ", begin, " to ", end);
    }
    if (end > point_count) {
      refuse("fibre ", fiber, ": offset ", end, " lies beyond the ", point_count, " points");
    }
    if (end - begin < 2) {
      refuse("fibre ", fiber, ": has ", end - begin, " point(s), a fibre needs at least 2");
    }
  }
  if (offsets.back() != point_count) {
    refuse("the last offset is ", offsets.back(), ", but there are ", point_count, " points");
  }
}

/// @param point_at the point of an index, to be checked
template <class PointAt>
void check_points(const PointAt& point_at, const std::vector<std::uint32_t>& offsets) {
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    for (std::size_t i = offsets[fiber]; i < offsets[fiber + 1]; ++i) {
      const Eigen::Vector3d& point = point_at(i);
      for (int axis = 0; axis < 3; ++axis) {
        if (!FiberAssembly::is_valid_coordinate(point[axis])) {
          refuse("fibre ", fiber, ", point ", i - offsets[fiber], ": ", "xyz"[axis], " is ",
                 point[axis], ", ", FiberAssembly::coordinate_rule);
        }
      }
    }
  }
}

void check_points(const std::vector<Eigen::Vector3d>& points,
                  const std::vector<std::uint32_t>& offsets) {
  check_points([&points](std::size_t i) -> const Eigen::Vector3d& { return points[i]; }, offsets);
}

void check_new_points(const std::vector<Eigen::Vector3d>& points, const FiberAssembly& fibers) {
  const bool are_stored = points.size() == fibers.point_count();
  if (!are_stored && points.size() != fibers.given_offsets().back()) {
    refuse("update with ", points.size(), " points for an assembly of ",
           fibers.given_offsets().back());
  }
  check_points(points, are_stored ? fibers.offsets() : fibers.given_offsets());
}

/// How so many radii are given; throws where they are none of these.
RadiusPer check_count(std::size_t radius_count, std::size_t fiber_count, std::size_t point_count) {
  if (radius_count == 1) {
    return RadiusPer::ASSEMBLY;
  }
  if (radius_count == fiber_count) {
    return RadiusPer::FIBER;
  }
  if (radius_count != point_count) {
    refuse(radius_count, " radii for ", fiber_count, " fibre(s) of ", point_count,
           " points in all; give 1, one per fibre, or one per point");
  }
  return RadiusPer::POINT;
}

RadiusPer check_radii(const std::vector<double>& radii, const std::vector<std::uint32_t>& offsets,
                      std::size_t point_count) {
  const RadiusPer radius_per = check_count(radii.size(), offsets.size() - 1, point_count);
  for (std::size_t i = 0; i < radii.size(); ++i) {
    if (FiberAssembly::is_valid_radius(radii[i])) {
      continue;
    }
    if (radius_per == RadiusPer::ASSEMBLY) {
      refuse("the radius is ", radii[i], ", ", FiberAssembly::radius_rule);
    }
    if (radius_per == RadiusPer::FIBER) {
      refuse("fibre ", i, ": the radius is ", radii[i], ", ", FiberAssembly::radius_rule);
    }
    const auto fiber = std::upper_bound(offsets.begin(), offsets.end(), i) - offsets.begin() - 1;
    refuse("fibre ", fiber, ", point ", i - offsets[static_cast<std::size_t>(fiber)],
           ": the radius is ", radii[i], ", ", FiberAssembly::radius_rule);
  }
  return radius_per;
}

std::vector<double> expand_radii(const std::vector<double>& radii, RadiusPer radius_per,
                                 const std::vector<std::uint32_t>& offsets,
                                 std::size_t point_count) {
  if (radius_per == RadiusPer::ASSEMBLY) {
    return {};
  }
  std::vector<double> segment_radii(point_count, 0.0);
  for (std::size_t fiber = 0; fiber + 1 < offsets.size(); ++fiber) {
    for (std::size_t point = offsets[fiber]; point + 1 < offsets[fiber + 1]; ++point) {
      segment_radii[point] =
          radius_per == RadiusPer::FIBER ? radii[fiber] : std::max(radii[point], radii[point + 1]);
    }
  }
  return segment_radii;
}

void check_segments(const std::vector<Eigen::Vector3d>& points,
                    const std::vector<std::uint32_t>& offsets,
                    const std::vector<double>& segment_radii) {
  check_offsets(offsets, points.size());
  check_points(points, offsets);
  if (segment_radii.size() != points.size() && segment_radii.size() != 1) {
    refuse(segment_radii.size(), " radii of segments for ", points.size(),
           " points; give 1 or one per point");
  }
  check_radii(segment_radii, offsets, points.size());
}

}  // namespace

FiberAssembly::FiberAssembly(std::vector<Eigen::Vector3d> points,
                             std::vector<std::uint32_t> offsets, std::vector<double> radii)
    : FiberAssembly(std::move(points), std::move(offsets), std::move(radii), {}) {}

FiberAssembly::FiberAssembly(std::vector<Eigen::Vector3d> points,
                             std::vector<std::uint32_t> offsets, std::vector<double> radii,
                             const FiberTopology& topology)
    : points_(std::move(points)), offsets_(std::move(offsets)), radii_(std::move(radii)) {
  check_offsets(offsets_, points_.size());
  check_points(points_, offsets_);
  radius_per_ = check_radii(radii_, offsets_, points_.size());
  graph_ = FiberGraph::make(offsets_, topology);
  if (graph_ != nullptr) {
    offsets_ = graph_->offsets();
    graph_->repeat_first_points(points_);
    if (radius_per_ == RadiusPer::POINT) {
      graph_->repeat_first_points(radii_);
    }
    check_offsets(offsets_, points_.size());  // there are more of them now
  }
  segment_radii_ = expand_radii(radii_, radius_per_, offsets_, points_.size());
  largest_radius_ = radii_.empty() ? 0.0 : *std::max_element(radii_.begin(), radii_.end());
  require_joints_meet(points_);
}

void FiberAssembly::require_joints_meet(const std::vector<Eigen::Vector3d>& points) const {
  if (graph_ != nullptr) {
    graph_->require_joints_meet(*this, points);
  }
}

void FiberAssembly::update_points(const std::vector<Eigen::Vector3d>& points, JointCheck check) {
  check_new_points(points, *this);
  if (check == JointCheck::REQUIRED) {
    require_joints_meet(points);
  }
  if (points.size() == points_.size()) {
    std::copy(points.begin(), points.end(), points_.begin());
  } else {
    points_.assign(points.begin(), points.end());
    graph_->repeat_first_points(points_);
  }
}

void FiberAssembly::exchange_points(std::vector<Eigen::Vector3d>& points) {
  check_new_points(points, *this);
  require_joints_meet(points);
  points_.swap(points);
  if (points_.size() != offsets_.back()) {
    graph_->repeat_first_points(points_);
  }
}

void FiberAssembly::join(std::shared_ptr<const FiberGraph> graph) {
  assert(graph->offsets() == offsets_ && graph->topology().closed.empty());
  graph_ = std::move(graph);
}

FiberTopology FiberAssembly::topology() const {
  return graph_ == nullptr ? FiberTopology() : graph_->topology();
}

bool FiberAssembly::is_closed(std::size_t fiber) const {
  return graph_ != nullptr && graph_->is_closed(static_cast<std::uint32_t>(fiber));
}

std::vector<Eigen::Vector3d> FiberAssembly::given_points() const {
  return graph_ == nullptr ? points_ : graph_->given(points_);
}

const std::vector<std::uint32_t>& FiberAssembly::given_offsets() const {
  return graph_ == nullptr ? offsets_ : graph_->given_offsets();
}

std::vector<double> FiberAssembly::given_radii() const {
  return graph_ == nullptr || radius_per_ != RadiusPer::POINT ? radii() : graph_->given(radii());
}

bool FiberAssembly::has_topology_of(const FiberAssembly& other) const {
  return offsets_ == other.offsets_ && join_alike(graph_.get(), other.graph_.get());
}

void FiberAssembly::transform(const Eigen::Isometry3d& pose) {
  check_points([&](std::size_t i) -> Eigen::Vector3d { return pose * points_[i]; }, offsets_);
  for (Eigen::Vector3d& point : points_) {
    point = pose * point;
  }
}

void FiberAssembly::assign_segments(const std::vector<Eigen::Vector3d>& points,
                                    const std::vector<std::uint32_t>& offsets,
                                    const std::vector<double>& segment_radii) {
  check_segments(points, offsets, segment_radii);
  points_ = points;
  offsets_ = offsets;
  segment_radii_ = segment_radii;
  become_segments();
}

void FiberAssembly::exchange_segments(std::vector<Eigen::Vector3d>& points,
                                      std::vector<std::uint32_t>& offsets,
                                      std::vector<double>& segment_radii) {
  check_segments(points, offsets, segment_radii);
  points_.swap(points);
  offsets_.swap(offsets);
  segment_radii_.swap(segment_radii);
  become_segments();
}

void FiberAssembly::become_segments() {
  graph_ = nullptr;
  radii_.clear();
  if (segment_radii_.size() == 1) {
    radii_.swap(segment_radii_);
  } else if (segment_radii_.empty()) {
    radii_.push_back(0.0);
  }
  radius_per_ = radii_.empty() ? RadiusPer::POINT : RadiusPer::ASSEMBLY;
  largest_radius_ = *std::max_element(radii().begin(), radii().end());
}

SegmentId FiberAssembly::segment_id(std::uint32_t point) const {
  assert(point < point_count());
  // Fibres are often of equal length: then the guess is right.
  const auto guess =
      static_cast<std::uint32_t>(std::uint64_t{point} * fiber_count() / point_count());
  if (offsets_[guess] <= point && point < offsets_[guess + 1]) {
    return {guess, point - offsets_[guess]};
  }
  const auto next = std::upper_bound(offsets_.begin(), offsets_.end(), point);
  assert(next != offsets_.begin() && next != offsets_.end() && point + 1 < *next);
  const auto fiber = static_cast<std::uint32_t>(next - offsets_.begin() - 1);
  return {fiber, point - offsets_[fiber]};
}

void require_coordinates(const char* name, const Eigen::Vector3d& vector) {
  for (int axis = 0; axis < 3; ++axis) {
    if (!FiberAssembly::is_valid_coordinate(vector[axis])) {
      refuse(name, ": ", "xyz"[axis], " is ", vector[axis], ", ", FiberAssembly::coordinate_rule);
    }
  }
}

FiberAssembly select_fibers(const FiberAssembly& fibers,
                            const std::vector<std::uint32_t>& selection) {
  const std::vector<double>& all_radii = fibers.radii();
  const FiberTopology all = fibers.topology();
  FiberTopology topology;
  std::vector<std::uint32_t> offsets{0};
  offsets.reserve(selection.size() + 1);
  for (const std::uint32_t fiber : selection) {
    assert(fiber < fibers.fiber_count());
    const std::vector<std::uint32_t>& given = fibers.given_offsets();
    offsets.push_back(offsets.back() + given[fiber + 1] - given[fiber]);
    if (!all.closed.empty()) {
      topology.closed.push_back(all.closed[fiber]);
    }
    if (!all.joints.empty()) {
      topology.joints.insert(topology.joints.end(), all.joints.begin() + given[fiber],
                             all.joints.begin() + given[fiber + 1]);
    }
  }
  if (fibers.graph() != nullptr) {
    topology.joint_tolerance = std::numeric_limits<double>::infinity();
  }
  std::vector<Eigen::Vector3d> points;
  points.reserve(offsets.back());
  std::vector<double> radii;
  for (std::size_t i = 0; i < selection.size(); ++i) {
    const std::uint32_t begin = fibers.offsets()[selection[i]];
    const std::uint32_t end = begin + (offsets[i + 1] - offsets[i]);
    points.insert(points.end(), fibers.points().begin() + begin, fibers.points().begin() + end);
    if (fibers.radius_per() == RadiusPer::FIBER) {
      radii.push_back(all_radii[selection[i]]);
    } else if (fibers.radius_per() == RadiusPer::POINT) {
      radii.insert(radii.end(), all_radii.begin() + begin, all_radii.begin() + end);
    }
  }
  if (radii.empty()) {
    radii.push_back(all_radii.front());
  }
  return {std::move(points), std::move(offsets), std::move(radii), topology};
}

}  // namespace fiber
