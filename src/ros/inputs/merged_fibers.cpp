#include "src/ros/inputs/merged_fibers.hpp"

#include <algorithm>

namespace fiber_proximity_ros {
namespace {

/// Writes the radii of one message out per fibre or per point.
void append_radii(const fiber::FiberAssembly& fibers, bool per_point, std::vector<double>& radii) {
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const std::size_t begin = fibers.offsets()[fiber];
    const std::size_t end = per_point ? fibers.offsets()[fiber + 1] : begin + 1;
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

void append(const FiberMessage& message, FiberBuffer& merged) {
  const fiber::FiberAssembly& fibers = message.fibers;
  const auto begin = static_cast<std::uint32_t>(merged.points.size());
  merged.points.insert(merged.points.end(), fibers.points().begin(), fibers.points().end());
  for (std::size_t fiber = 1; fiber < fibers.offsets().size(); ++fiber) {
    merged.offsets.push_back(begin + fibers.offsets()[fiber]);
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
