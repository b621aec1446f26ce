#include "src/ros/environment/object_tracks.hpp"

namespace fiber_proximity_ros {

void ObjectTracks::keep(std::size_t frames) {
  if (frames != frames_) {
    frames_ = frames;
    tracks_.clear();
  }
}

void ObjectTracks::take(const fiber::ObjectChange& change, const ros::Time& stamp) {
  using Operation = fiber::ObjectChange::Operation;
  const fiber::EnvironmentObject& object = change.object;
  if (frames_ == 0) {
    return;
  }
  switch (change.operation) {
    case Operation::ADD:
      forget(object.name);
      track_of(object.name).add(stamp.toSec(), object.pose);
      break;
    case Operation::MOVE:
      track_of(object.name).add(stamp.toSec(), object.pose);
      break;
    case Operation::REMOVE:
      forget(object.name);
      break;
    case Operation::APPEND:
      break;  // its pose stays
  }
}

void ObjectTracks::observe(const std::string& name, const Eigen::Isometry3d& pose,
                           const ros::Time& stamp) {
  if (frames_ == 0) {
    return;
  }
  fiber::PoseVelocity& track = track_of(name);
  if (track.frame_count() == 0 || track.time() != stamp.toSec()) {
    track.add(stamp.toSec(), pose);
  }
}

}  // namespace fiber_proximity_ros
