#include "src/ros/environment/owed_changes.hpp"

#include <iterator>

#include "src/ros/environment/waiting_changes.hpp"

namespace fiber_proximity_ros {

void OwedChanges::refuse(const std::string& topic, const TouchedObjects& touched,
                         const ros::Time& now, const std::string& reason) {
  const auto note = [&](const std::string& what, bool is_of_place) {
    Owed& owed =
        owed_.try_emplace(what, Owed{{topic, what, now, "", true}, is_of_place}).first->second;
    owed.unknown.why = "refused: " + reason;
    owed.is_of_place = owed.is_of_place && is_of_place;
  };
  for (const std::string& name : touched.names()) {
    if (touched.wants(name)) {
      if (owed_.size() < max_obstacles || owed_.count(name) > 0) {
        note(name, touched.only_moves(name));
      } else {
        note("obstacles of " + topic, false);
      }
    } else {
      owed_.erase(name);  // it is not there, or it is there still
    }
  }
}

void OwedChanges::settle(const std::string& topic, const TouchedObjects& touched) {
  if (touched.is_everything()) {
    for (auto owed = owed_.begin(); owed != owed_.end();) {
      owed = topic.empty() || owed->second.unknown.source == topic ? owed_.erase(owed)
                                                                   : std::next(owed);
    }
  }
  for (const std::string& name : touched.names()) {
    const auto owed = owed_.find(name);
    if (owed != owed_.end() &&
        (touched.makes_anew(name) || (touched.moves(name) && owed->second.is_of_place))) {
      owed_.erase(owed);
    }
  }
}

std::vector<Unknown> OwedChanges::unknown() const {
  std::vector<Unknown> unknown;
  for (const auto& [what, owed] : owed_) {
    unknown.push_back(owed.unknown);
  }
  return unknown;
}

}  // namespace fiber_proximity_ros
