#include "src/ros/inputs/merged_fibers.hpp"

#include <algorithm>

namespace fiber_proximity_ros {
namespace {

bool has_radius_per_point(const fiber::FiberAssembly& fibers) {
  return fibers.radii().size() > 1 && fibers.radii().size() == fibers.point_count();
}

/// Writes the radii of one input out per fibre or per point.
void append_radii(const fiber::FiberAssembly& fibers, bool per_point, std::vector<double>& radii) {
  if (per_point && has_radius_per_point(fibers)) {
    radii.insert(radii.end(), fibers.radii().begin(), fibers.radii().end());
    return;
  }
  for (std::size_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    const double radius = fibers.radii()[fibers.radii().size() == 1 ? 0 : fiber];
    const std::size_t points = fibers.offsets()[fiber + 1] - fibers.offsets()[fiber];
    radii.insert(radii.end(), per_point ? points : 1, radius);
  }
}

/// The shortest form that holds the radii of all: one, one per fibre, or one per point.
void merge_radii(const std::vector<FiberMessagePtr>& messages, std::vector<double>& radii) {
  const std::vector<double>& first = messages.front()->fibers.radii();
  if (first.size() == 1 && std::all_of(messages.begin(), messages.end(), [&](const auto& message) {
        return message->fibers.radii() == first;
      })) {
    radii = first;
    return;
  }
  const bool per_point = std::any_of(messages.begin(), messages.end(), [](const auto& message) {
    return has_radius_per_point(message->fibers);
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
