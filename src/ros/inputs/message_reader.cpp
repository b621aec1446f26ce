#include "src/ros/inputs/message_reader.hpp"

#include <stdexcept>
#include <utility>

#include "src/ros/inputs/closed_fibers.hpp"
#include "src/ros/inputs/fixed_frame.hpp"

namespace fiber_proximity_ros {
namespace {

/// Names fibres by the input where the message does not, before any are left out or cut, so that
/// the others keep their names.
void name_fibers(const std::string& input, FiberBuffer& fibers) {
  if (!fibers.names.empty()) {
    return;
  }
  fibers.names.assign(fibers.fiber_count(), input);
  for (std::size_t i = 0; fibers.names.size() > 1 && i < fibers.names.size(); ++i) {
    fibers.names[i] += "/" + std::to_string(i);
  }
}

}  // namespace

FiberMessagePtr MessageReader::read(const ReadMessage& read, InputStamps& stamps) {
  ReadResult result = read(buffer_);
  if (!result.is_for_input) {
    return nullptr;
  }
  std_msgs::Header& header = buffer_.header;
  header.frame_id = tf2_name(header.frame_id);
  if (header.frame_id.empty()) {
    throw std::invalid_argument("header.frame_id is empty, it must name the frame of the points");
  }
  const ros::Time now = ros::Time::now();
  const ros::Time stamp = header.stamp.isZero() ? now : header.stamp;
  stamps.check(stamp, now);
  if (stamps.repeats(header.stamp, result.is_news)) {
    return nullptr;
  }
  name_fibers(options_.name, buffer_);
  if (options_.close_rings) {
    close_rings(buffer_);
  }
  const std::uint64_t gaps_before = missing_.gaps;
  resolve_missing_points(options_.missing_points, buffer_, missing_);
  if (buffer_.radii.empty()) {
    buffer_.radii.assign(1, options_.radius);
  }
  FiberMessagePtr message = pool_.take();
  assign(buffer_, message->fibers);
  message->names.swap(buffer_.names);
  message->missing = std::move(result.missing);
  if (const std::uint64_t gaps = missing_.gaps - gaps_before; gaps > 0) {
    message->missing += (message->missing.empty() ? "" : ", ") + std::to_string(gaps) +
                        " of its points are missing";
  }
  message->header = header;
  message->stamp = stamp;
  message->arrival = now;
  message->steady_arrival = ros::SteadyTime::now();
  remarks_ = std::move(result.remarks);
  for (const fiber::LonelyJoint& lonely : fiber::lonely_joints(buffer_.topology.joints)) {
    remarks_.push_back("joint " + std::to_string(lonely.joint) + " is the number of point " +
                       std::to_string(lonely.point) + " alone: it joins nothing");
  }
  return message;
}

void MessageReader::release() {
  buffer_ = {};
  pool_.clear();
}

}  // namespace fiber_proximity_ros
