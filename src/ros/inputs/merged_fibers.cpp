#include "src/ros/inputs/merged_fibers.hpp"

#include <algorithm>
#include <limits>
#include <map>

namespace fiber_proximity_ros {
namespace {

/// Writes the radii of one message out per fibre or per point.
void append_radii(const fiber::FiberAssembly& fibers, bool per_point, std::vector<double>& radii) {
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::size_t begin = fibers.offsets()[fiber];
    const std::size_t count = fibers.given_offsets()[fiber + 1] - fibers.given_offsets()[fiber];
    const std::size_t end = begin + (per_point ? count : 1);
    for (std::size_t point = begin; point < end; ++point) {
      radii.push_back(fibers.radius_at(fiber, point));
    }
  }
}

/// Finds the shortest form that holds the radii of all: one, one per fibre, or one per point.
void merge_radii(const std::vector<FiberMessagePtr>& messages, std::vector<double>& radii) {
  const std::vector<double>& first = messages.front()->fibers.radii();
  const auto has_first = [&](const auto& message) { return message->fibers.radii() == first; };
  if (first.size() == 1 && std::all_of(messages.begin(), messages.end(), has_first)) {
    radii = first;
    return;
  }
  const bool per_point = std::any_of(messages.begin(), messages.end(), [](const auto& message) {
    return message->fibers.radius_per() == fiber::RadiusPer::POINT;
  });
  for (const FiberMessagePtr& message : messages) {
    append_radii(message->fibers, per_point, radii);
  }
}

/// Adds what is closed and joined; numbers of joints of two messages have nothing to do with each
/// other.
void append_topology(const fiber::FiberAssembly& fibers, std::size_t fibers_before,
                     std::size_t points_before, fiber::FiberTopology& merged) {
  if (fibers.graph() == nullptr && merged.closed.empty() && merged.joints.empty()) {
    return;
  }
  const fiber::FiberTopology topology = fibers.topology();
  merged.closed.resize(fibers_before, 0);
  merged.joints.resize(points_before, -1);
  merged.joint_tolerance = std::numeric_limits<double>::infinity();  // each message was asked
  std::int32_t next_joint = 0;
  for (const std::int32_t joint : merged.joints) {
    next_joint = std::max(next_joint, joint + 1);
  }
  std::map<std::int32_t, std::int32_t> numbers;
  for (const std::int32_t joint : topology.joints) {
    const auto next = next_joint + static_cast<std::int32_t>(numbers.size());
    merged.joints.push_back(joint < 0 ? joint : numbers.try_emplace(joint, next).first->second);
  }
  merged.closed.insert(merged.closed.end(), topology.closed.begin(), topology.closed.end());
  merged.closed.resize(fibers_before + fibers.fiber_count(), 0);
  merged.joints.resize(points_before + fibers.given_offsets().back(), -1);
}

void append(const FiberMessage& message, FiberBuffer& merged) {
  const fiber::FiberAssembly& fibers = message.fibers;
  const auto begin = static_cast<std::uint32_t>(merged.points.size());
  append_topology(fibers, merged.fiber_count(), begin, merged.topology);
  if (fibers.graph() == nullptr) {
    merged.points.insert(merged.points.end(), fibers.points().begin(), fibers.points().end());
  } else {
    const std::vector<Eigen::Vector3d> points = fibers.given_points();
    merged.points.insert(merged.points.end(), points.begin(), points.end());
  }
  const std::vector<std::uint32_t>& offsets = fibers.given_offsets();
  for (std::size_t fiber = 1; fiber < offsets.size(); ++fiber) {
    merged.offsets.push_back(begin + offsets[fiber]);
  }
  merged.names.insert(merged.names.end(), message.names.begin(), message.names.end());
}

}  // namespace

void MergedFibers::merge(const std::vector<FiberMessagePtr>& messages) {
  if (messages.size() == 1) {
    message_ = messages.front();
    return;
  }
  message_.reset();
  const FiberMessagePtr merged = pool_.take();
  buffer_.clear();
  buffer_.names.swap(merged->names);  // the names before, for their memory
  buffer_.names.clear();
  merged->stamp = ros::Time();
  std::size_t point_count = 0;
  for (const FiberMessagePtr& message : messages) {
    point_count += message->fibers.point_count();
  }
  buffer_.points.reserve(point_count);
  for (const FiberMessagePtr& message : messages) {
    append(*message, buffer_);
    merged->stamp = std::max(merged->stamp, message->stamp);
  }
  if (!messages.empty()) {
    merge_radii(messages, buffer_.radii);
  }
  assign(buffer_, merged->fibers);
  merged->names.swap(buffer_.names);
  message_ = merged;
}

}  // namespace fiber_proximity_ros
