#include "fiber_proximity/sim/moving_obstacles.hpp"

#include <algorithm>
#include <cassert>
#include <stdexcept>

#include "src/environment/object_path.hpp"
#include "src/text/quote.hpp"
#include "src/text/with_context.hpp"

namespace fiber {

using Eigen::Isometry3d;

namespace {

Isometry3d placed_at(const MovingObstacle& obstacle, const std::string& title, double time) {
  return with_context(title, [&] {
    const Isometry3d pose = obstacle.placement(time);
    fiber::validate(pose);
    return pose;
  });
}

}  // namespace

ObstacleMotions* Contacts::motions() const {
  return motions_ != nullptr && !motions_->obstacles().empty() ? motions_.get() : nullptr;
}

ObstacleMotions::ObstacleMotions(std::vector<MovingObstacle> obstacles, std::uint32_t first_index)
    : first_index_(first_index) {
  for (MovingObstacle& obstacle : obstacles) {
    add(std::move(obstacle), 0.0);
  }
}

void ObstacleMotions::add(MovingObstacle obstacle, double time) {
  const std::string title = "obstacle " + quote(obstacle.object.name);
  obstacle.object.pose = placed_at(obstacle, title, time);
  validate(obstacle.object);
  const Isometry3d& pose = obstacle.object.pose;
  poses_.push_back(pose);
  begin_.push_back(pose);
  motions_.push_back({pose, pose, pose, 0.0});
  obstacles_.push_back(std::move(obstacle));
  titles_.push_back(title);
  ++revision_;
}

void ObstacleMotions::remove(std::uint32_t obstacle) {
  require(obstacle);
  const auto erase = [obstacle](auto& list) { list.erase(list.begin() + obstacle); };
  erase(obstacles_);
  erase(titles_);
  erase(poses_);
  erase(begin_);
  erase(motions_);
  ++revision_;
}

std::vector<EnvironmentObject> ObstacleMotions::placed() const {
  std::vector<EnvironmentObject> objects;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    objects.push_back(obstacles_[i].object);
    objects.back().pose = poses_[i];
  }
  return objects;
}

std::optional<ObstacleLag> ObstacleMotions::longest_lag(double time) const {
  constexpr double min_angle = 1e-6;      // [rad]
  constexpr double min_distance = 1e-12;  // [m] more than rounding
  std::optional<ObstacleLag> longest;
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    const Isometry3d wanted = obstacles_[i].placement(time);
    const double distance = (wanted.translation() - poses_[i].translation()).norm();
    const Eigen::AngleAxisd turn(Eigen::Matrix3d(poses_[i].linear().transpose() * wanted.linear()));
    if (wanted.isApprox(poses_[i], 0.0)) {
      continue;
    }
    const bool is_longer = !longest || distance > longest->distance ||
                           (distance == longest->distance && turn.angle() > longest->angle);
    if ((distance > min_distance || turn.angle() > min_angle) && is_longer) {
      longest = {static_cast<std::uint32_t>(i), distance, turn.angle()};
    }
  }
  return longest;
}

void ObstacleMotions::require(std::uint32_t obstacle) const {
  if (obstacle >= obstacles_.size()) {
    throw std::invalid_argument("there is no moving obstacle " + std::to_string(obstacle) +
                                ", there are " + std::to_string(obstacles_.size()));
  }
}

void ObstacleMotions::place(std::uint32_t obstacle, const Isometry3d& pose) {
  require(obstacle);
  poses_[obstacle] = pose;
}

void ObstacleMotions::redirect(std::uint32_t obstacle,
                               std::function<Isometry3d(double time)> placement) {
  require(obstacle);
  obstacles_[obstacle].placement = std::move(placement);
}

void ObstacleMotions::begin_step(double time) {
  begin_time_ = time;
  begin_ = poses_;
}

void ObstacleMotions::begin_solve(double time) {
  for (std::size_t i = 0; i < obstacles_.size(); ++i) {
    motions_[i] = {begin_[i], poses_[i], placed_at(obstacles_[i], titles_[i], time),
                   time - begin_time_};
  }
}

void ObstacleMotions::shorten(const std::vector<bool>& which, double share) {
  assert(which.size() == motions_.size());
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    if (which[i]) {
      ObstacleMotion& motion = motions_[i];
      motion.end = share == 0.0 ? motion.start
                                : ObjectPath(motion.start, Isometry3d(motion.end)).pose(share);
    }
  }
}

void ObstacleMotions::end_solve() {
  for (std::size_t i = 0; i < motions_.size(); ++i) {
    poses_[i] = motions_[i].end;
  }
}

}  // namespace fiber
