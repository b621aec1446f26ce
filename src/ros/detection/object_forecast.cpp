#include "src/ros/detection/object_forecast.hpp"

#include <algorithm>
#include <sstream>

namespace fiber_proximity_ros {
namespace {

/// The first of some names, and how many more there are.
class NameList {
 public:
  void add(const std::string& name) {
    constexpr std::size_t max_shown = 8;
    if (++count_ <= max_shown) {
      shown_ += (shown_.empty() ? "" : ", ") + name;
    } else {
      ++hidden_;
    }
  }

  bool is_empty() const { return count_ == 0; }
  std::string text() const {
    return shown_ + (hidden_ == 0 ? "" : " and " + std::to_string(hidden_) + " more");
  }

 private:
  std::size_t count_ = 0;
  std::size_t hidden_ = 0;
  std::string shown_;
};

}  // namespace

ObjectForecast::ObjectForecast(const fiber::Environment& environment, const ObjectTracks& tracks,
                               const ros::Time& stamp, double timeout, double horizon)
    : displacements(environment.objects().size()), time(horizon) {
  std::vector<fiber::BodyTwist> twists(displacements.size());
  NameList movers;
  NameList others;
  double max_rate = 0.0;  // [rad/s]
  for (std::size_t i = 0; i < twists.size(); ++i) {
    const std::string& name = environment.objects()[i].name;
    const fiber::PoseVelocity* const track = tracks.find(name);
    if (track == nullptr || track->frame_count() < 2 || stamp.toSec() - track->time() > timeout) {
      others.add(name);
      continue;
    }
    movers.add(name);
    twists[i] = track->find();
    max_rate = std::max(max_rate, twists[i].angular.norm());
    frames = moving == 0 ? track->frame_count() : std::min(frames, track->frame_count());
    frame_time = moving == 0 ? track->duration() : std::min(frame_time, track->duration());
    ++moving;
  }
  constexpr double max_turn = 0.99 * fiber::ObjectDisplacement::max_rotation;  // rounding apart
  if (max_rate * horizon > max_turn) {
    time = max_turn / max_rate;
    std::ostringstream text;
    text << "prediction: objects are not looked at after " << time << " s, as one has turned by "
         << max_turn << " rad by then";
    limit = text.str();
  }
  for (std::size_t i = 0; i < twists.size(); ++i) {
    displacements[i] = {time * twists[i].linear, time * twists[i].angular};
  }
  if (moving == 0) {
    assumption = "objects stand still" + (others.is_empty() ? "" : " (" + others.text() + ")");
    return;
  }
  std::ostringstream text;
  text << "objects keep the velocity and the rate of turning about their origin of the lines of "
          "least squares through their last poses, at least "
       << frames << " over " << frame_time << " s (" << movers.text() << ")";
  if (!others.is_empty()) {
    text << " or stand still (" << others.text() << ")";
  }
  assumption = text.str();
}

}  // namespace fiber_proximity_ros
