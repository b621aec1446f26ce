#include "src/ros/environment/waiting_changes.hpp"

#include <algorithm>
#include <exception>
#include <iterator>
#include <utility>

namespace fiber_proximity_ros {

void TouchedObjects::add(const std::string& name) {
  names_.insert(name);
  wanted_.insert(name);
  made_anew_.insert(name);
}

void TouchedObjects::append(const std::string& name) {
  names_.insert(name);
  wanted_.insert(name);
  appended_.insert(name);
}

void TouchedObjects::move(const std::string& name) {
  names_.insert(name);
  wanted_.insert(name);
  moved_.insert(name);
}

void TouchedObjects::remove(const std::string& name) {
  made_anew_.insert(name);
  wanted_.erase(name);
  if (names_.insert(name).second) {
    removed_first_.insert(name);
  }
}

void TouchedObjects::remove_all() {
  removes_everything_first_ = removes_everything_first_ || (names_.empty() && !is_everything_);
  is_everything_ = true;
  wanted_.clear();
}

bool TouchedObjects::overlaps(const TouchedObjects& other) const {
  return is_everything_ || other.is_everything_ ||
         std::any_of(names_.begin(), names_.end(),
                     [&other](const std::string& name) { return other.names_.count(name) > 0; });
}

bool TouchedObjects::is_undone_by(const TouchedObjects& later) const {
  const auto& removed = later.removed_first_;
  return later.removes_everything_first_ ||
         (!is_everything_ &&
          std::includes(removed.begin(), removed.end(), names_.begin(), names_.end()));
}

Eigen::Isometry3d locate(const FramedName& thing, FixedFrame& frame) {
  std_msgs::Header header = thing.header;
  header.frame_id = tf2_name(header.frame_id);
  frame.adopt(header.frame_id);
  return naming(thing.name, [&] { return frame.transform_from(header); });
}

WaitingChanges::Waiting::Waiting(Change received) : change(std::move(received)) {
  poses.reserve(change.frames.size());
}

/// A malformed change does not choose the fixed frame.
void WaitingChanges::Waiting::find_poses(FixedFrame& frame) {
  while (!is_placed() && (apply || !frame.name().empty())) {
    const FramedName& next = change.frames[poses.size()];
    if (!missing.empty() && !frame.knows(next.header)) {
      return;  // the same as before, without the cost of an exception
    }
    try {
      poses.push_back(locate(next, frame));
      missing.clear();
    } catch (const TransformUnavailable& error) {
      missing = error.what();
      return;
    }
  }
}

const std::string* WaitingChanges::Blocked::find(const TouchedObjects& touched) const {
  if (everything) {
    return &*everything;
  }
  if (touched.is_everything() && !names.empty()) {
    return &any;
  }
  const std::string* found = nullptr;
  for (const std::string& name : touched.names()) {
    const auto blocked = names.find(name);
    if (blocked != names.end() && (found == nullptr || found->empty())) {
      found = &blocked->second;
    }
  }
  return found;
}

void WaitingChanges::Blocked::add(const TouchedObjects& touched, const std::string& missing) {
  const auto note = [&missing](std::string& why) { why = why.empty() ? missing : why; };
  note(any);
  for (const std::string& name : touched.names()) {
    note(names[name]);
  }
  if (touched.is_everything()) {
    everything = everything.value_or("");
    note(*everything);
  }
}

void WaitingChanges::receive(Change change) {
  waiting_.emplace_back(std::move(change));
  waiting_.back().find_poses(frame_);
  if (waiting_.size() > max_waiting) {
    refuse(waiting_.back(), std::to_string(max_waiting) + " changes are waiting already");
    waiting_.pop_back();
  }
}

std::vector<Unknown> WaitingChanges::unknown(
    const std::function<bool(const std::string&)>& is_there, double lateness) const {
  std::vector<Unknown> unknown;
  const ros::SteadyTime now = ros::SteadyTime::now();
  for (const Waiting& waiting : waiting_) {
    const bool is_late = (now - waiting.arrival).toSec() > lateness;
    for (const std::string& name : waiting.change.touched.names()) {
      if (waiting.change.touched.wants(name) && (is_late || !is_there(name))) {
        unknown.push_back(
            {waiting.change.source, name, waiting.since,
             waiting.missing.empty() ? "its change is not made yet" : waiting.missing});
      }
    }
  }
  return unknown;
}

bool WaitingChanges::update() {
  bool applied = false;
  Blocked blocked;
  for (auto place = waiting_.begin(); place != waiting_.end();) {
    const std::string* before = blocked.find(place->change.touched);
    const std::size_t count = waiting_.size();
    const bool has_ended = advance(place, before, applied);
    const bool has_overtaken = waiting_.size() != count;
    if (has_ended) {
      place = waiting_.erase(place);
    }
    if (has_overtaken) {  // others no longer wait for what it has undone
      blocked = {};
      place = waiting_.begin();
    } else if (!has_ended) {
      const bool is_before_missing = place->missing.empty() && before != nullptr;
      blocked.add(place->change.touched, is_before_missing ? *before : place->missing);
      ++place;
    }
  }
  return applied;
}

bool WaitingChanges::advance(Queue::iterator place, const std::string* blocked, bool& applied) {
  Waiting& waiting = *place;
  try {
    if (!waiting.apply && waiting.change.apply.is_ready()) {
      waiting.apply = waiting.change.apply.get();
    }
    waiting.find_poses(frame_);
    if (waiting.is_placed() && waiting.apply && make(place, blocked == nullptr)) {
      applied = true;
      waiting.change.on_end(Change::End::APPLIED, "");
      return true;
    }
  } catch (const std::exception& error) {
    return refuse(waiting, error.what());
  }
  const std::string& missing =
      waiting.missing.empty() && blocked != nullptr ? *blocked : waiting.missing;
  const double waited = (ros::SteadyTime::now() - waiting.arrival).toSec();
  return !missing.empty() && waited >= waiting.change.patience && refuse(waiting, missing);
}

/// Makes a change that is ready if it is its turn, or if it undoes all that it would wait for.
bool WaitingChanges::make(Queue::iterator place, bool is_first) {
  const TouchedObjects& touched = place->change.touched;
  if (!is_first && !touched.begins_with_removal()) {
    return false;
  }
  std::vector<Queue::iterator> undone;
  Change::Names cancelled;
  for (auto earlier = is_first ? place : waiting_.begin(); earlier != place; ++earlier) {
    const TouchedObjects& other = earlier->change.touched;
    if (touched.overlaps(other)) {
      if (!other.is_undone_by(touched)) {
        return false;
      }
      undone.push_back(earlier);
      cancelled.insert(other.names().begin(), other.names().end());
    }
  }
  (*place->apply)(place->poses, cancelled);
  for (const Queue::iterator change : undone) {
    change->change.on_end(Change::End::OVERTAKEN, "");
    waiting_.erase(change);
  }
  return true;
}

bool WaitingChanges::refuse(const Waiting& waiting, const std::string& reason) const {
  waiting.change.on_end(Change::End::REFUSED, reason);
  return true;
}

Change ChangeTopic::received(Change change) {
  log_.receive();
  change.source = topic_;
  change.on_end = [this, touched = change.touched](Change::End end, const std::string& reason) {
    if (end == Change::End::APPLIED) {
      last_applied_ = ros::Time::now();
      log_.accept();
      owed_.settle(scope_, touched);
    } else if (end == Change::End::REFUSED) {
      log_.refuse(reason);
      owed_.refuse(topic_, touched, ros::Time::now(), reason);
    } else {
      log_.overtake();
    }
  };
  return change;
}

fiber_proximity::InputStatistics ChangeTopic::statistics(const ros::Time& now) const {
  fiber_proximity::InputStatistics statistics = log_.statistics();
  if (last_applied_) {
    statistics.age = (now - *last_applied_).toSec();
  }
  return statistics;
}

std::optional<Unknown> ChangeTopic::unknown() const {
  if (!required_ || last_applied_) {
    return std::nullopt;
  }
  const std::string& refused = log_.refused_since();
  return Unknown{topic_, "obstacles of " + topic_, beginning_,
                 "no message yet" + (refused.empty() ? "" : " but what was refused: " + refused)};
}

}  // namespace fiber_proximity_ros
