#include "src/ros/inputs/marker_input.hpp"

#include <algorithm>
#include <iterator>
#include <set>
#include <sstream>
#include <stdexcept>
#include <utility>

namespace fiber_proximity_ros {

using visualization_msgs::Marker;

bool MarkerInput::is_wanted(const Marker& marker) const {
  return marker.action == Marker::DELETEALL || options_.marker_namespace.empty() ||
         options_.marker_namespace == marker.ns;
}

/// @returns whether that has changed something
bool MarkerInput::apply(const MarkerPtr& marker, const ros::Time& now, Kepts& kept) const {
  const Key key{marker->ns, marker->id};
  switch (marker->action) {
    case Marker::DELETEALL: {
      const bool was_empty = kept.empty();
      kept.clear();
      return !was_empty;
    }
    case Marker::DELETE:
      return kept.erase(key) > 0;
    case Marker::ADD:
      break;
    default:
      throw std::invalid_argument(name_of(*marker) + ": action is " +
                                  std::to_string(marker->action) +
                                  ", it must be 0 (ADD), 2 (DELETE) or 3 (DELETEALL)");
  }
  if (marker->lifetime < ros::Duration()) {
    std::ostringstream error;
    error << name_of(*marker) << ": lifetime is " << marker->lifetime
          << " s, it must be at least 0";
    throw std::invalid_argument(error.str());
  }
  const auto known = kept.find(key);
  if (known != kept.end() && !marker->header.stamp.isZero() &&
      known->second.marker->header.stamp == marker->header.stamp) {
    return false;  // a tracker that has frozen
  }
  const ros::Time expiry = marker->lifetime.isZero() ? ros::Time() : now + marker->lifetime;
  kept[key] = {marker, now, expiry};
  return true;
}

bool MarkerInput::is_late(const Kept& kept, const ros::Time& now) const {
  return (now - kept.arrival).toSec() > options_.timeout;
}

ReadResult MarkerInput::read(const std::vector<MarkerPtr>& message, const ros::Time& now,
                             FiberBuffer& fibers) {
  ReadResult result;
  result.is_for_input = std::any_of(message.begin(), message.end(),
                                    [this](const MarkerPtr& marker) { return is_wanted(*marker); });
  if (!result.is_for_input) {
    return result;
  }
  next_ = now < state_.last_read ? State() : state_;  // time may start again
  next_.last_read = now;
  Kepts& kept = next_.kept;
  for (auto each = kept.begin(); each != kept.end();) {
    const bool is_over = !each->second.expiry.isZero() && each->second.expiry <= now;
    each = is_over ? kept.erase(each) : std::next(each);
    result.is_news = result.is_news || is_over;
  }
  std::set<Key> added;
  for (const MarkerPtr& marker : message) {
    if (!is_wanted(*marker)) {
      continue;
    }
    result.is_news = apply(marker, now, kept) || result.is_news;
    if (marker->action == Marker::ADD && !added.emplace(marker->ns, marker->id).second) {
      result.remarks.push_back(name_of(*marker) +
                               " is in a message more than once: as in rviz, the last one counts");
    }
  }
  if (kept.size() > max_markers) {
    throw std::invalid_argument("there are more than " + std::to_string(max_markers) +
                                " markers now, which nobody has deleted");
  }
  std::vector<const Marker*> shown;
  const std::size_t late_before = std::exchange(next_.late_count, 0);
  for (const auto& [key, each] : kept) {
    if (!is_late(each, now)) {
      shown.push_back(each.marker.get());
    } else if (++next_.late_count == 1) {
      std::ostringstream missing;
      missing << name_of(*each.marker) << " was not sent again for " << options_.timeout << " s";
      result.missing = missing.str();
    }
  }
  if (next_.late_count > 1) {
    result.missing += ", nor were " + std::to_string(next_.late_count - 1) + " others";
  }
  result.is_news = result.is_news || next_.late_count != late_before;
  fibers.clear();
  if (!shown.empty()) {
    to_chains(shown, options_, fibers, result.remarks);
    next_.header.frame_id = fibers.header.frame_id;
  }
  // The stamp is the newest of all markers in the message, deletions included. It stays zero, which
  // means the time of arrival, where none of them has a stamp.
  ros::Time newest;
  for (const MarkerPtr& marker : message) {
    newest = std::max(newest, marker->header.stamp);
  }
  next_.header.stamp = newest.isZero() ? newest : std::max(newest, next_.header.stamp);
  fibers.header = next_.header;
  result.is_for_input = !next_.header.frame_id.empty();  // else there have been none yet
  return result;
}

}  // namespace fiber_proximity_ros
