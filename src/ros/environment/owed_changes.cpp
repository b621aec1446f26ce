#include "src/ros/environment/owed_changes.hpp"

#include <iterator>

#include "src/ros/environment/waiting_changes.hpp"

namespace fiber_proximity_ros {

void OwedChanges::refuse(const std::string& topic, const TouchedObjects& touched,
                         const ros::Time& now, const std::string& reason) {
  const auto note = [&](const std::string& what) {
    owed_.try_emplace(what, Unknown{topic, what, now, "", true}).first->second.why =
        "refused: " + reason;
  };
  for (const std::string& name : touched.names()) {
    if (touched.wants(name)) {
      const bool is_known = owed_.size() < max_obstacles || owed_.count(name) > 0;
      note(is_known ? name : "obstacles of " + topic);
    } else {
      owed_.erase(name);  // it is not there, or it is there still
    }
  }
}

void OwedChanges::settle(const std::string& topic, const TouchedObjects& touched) {
  if (touched.is_everything()) {
    for (auto owed = owed_.begin(); owed != owed_.end();) {
      owed = topic.empty() || owed->second.source == topic ? owed_.erase(owed) : std::next(owed);
    }
  }
  for (const std::string& name : touched.names()) {
    owed_.erase(name);
  }
}

std::vector<Unknown> OwedChanges::unknown() const {
  std::vector<Unknown> unknown;
  for (const auto& [what, owed] : owed_) {
    unknown.push_back(owed);
  }
  return unknown;
}

}  // namespace fiber_proximity_ros
