#include "src/ros/environment/allowed_pairs_service.hpp"

#include <ros/console.h>

#include <algorithm>
#include <exception>
#include <utility>

namespace fiber_proximity_ros {
namespace {

std::vector<fiber::NamedPair> to_pairs(const std::vector<fiber_proximity::AllowedPair>& messages) {
  std::vector<fiber::NamedPair> pairs;
  for (const fiber_proximity::AllowedPair& message : messages) {
    pairs.push_back({message.object, message.fiber, message.segments});
  }
  return pairs;
}

std::vector<fiber_proximity::AllowedPair> to_messages(const std::vector<fiber::NamedPair>& pairs) {
  std::vector<fiber_proximity::AllowedPair> messages(pairs.size());
  for (std::size_t i = 0; i < pairs.size(); ++i) {
    messages[i].object = pairs[i].object;
    messages[i].fiber = pairs[i].fiber;
    messages[i].segments = pairs[i].segments;
  }
  return messages;
}

}  // namespace

AllowedPairsService::AllowedPairsService(ros::NodeHandle private_node,
                                         const std::vector<fiber::NamedPair>& allowed,
                                         std::function<void()> on_change)
    : node_name_(private_node.getNamespace()), on_change_(std::move(on_change)) {
  allowed_.apply(false, {}, allowed);
  warn();
  server_ = private_node.advertiseService("allow_pairs", &AllowedPairsService::answer, this);
}

bool AllowedPairsService::may_touch_all(const std::string& object) const {
  return std::any_of(pairs().begin(), pairs().end(), [&object](const fiber::NamedPair& pair) {
    return pair.fiber.empty() && pair.segments.empty() &&
           (pair.object.empty() || pair.object == object);
  });
}

/// Pairs that are allowed without naming them are easily forgotten, and left by an earlier launch.
void AllowedPairsService::warn() const {
  if (may_touch_all("")) {
    ROS_WARN_STREAM(node_name_ << ": every object may touch every fibre, as a pair of `allowed` "
                                  "names neither: no contacts with objects are reported");
  }
}

bool AllowedPairsService::answer(fiber_proximity::AllowPairs::Request& request,
                                 fiber_proximity::AllowPairs::Response& response) {
  try {
    allowed_.apply(request.reset != 0, to_pairs(request.forbid), to_pairs(request.allow));
    warn();
    response.success = true;
    on_change_();
  } catch (const std::exception& error) {
    response.message = error.what();
  }
  response.allowed = to_messages(pairs());
  return true;
}

}  // namespace fiber_proximity_ros
