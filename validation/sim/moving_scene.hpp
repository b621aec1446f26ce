#pragma once

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber {

using PoseInTime = std::function<Eigen::Isometry3d(double time)>;

inline Eigen::Isometry3d at_place(const Eigen::Vector3d& place) {
  return Eigen::Isometry3d(Eigen::Translation3d(place));
}

inline MovingObstacle moving(const std::string& name, const Shape& shape, PoseInTime placement) {
  MovingObstacle obstacle;
  obstacle.object.name = name;
  obstacle.object.shapes.push_back({shape, Eigen::Isometry3d::Identity()});
  obstacle.placement = std::move(placement);
  return obstacle;
}

inline MovingObstacle going(const Shape& shape, const Eigen::Vector3d& from,
                            const Eigen::Vector3d& velocity) {
  return moving("mover", shape, [=](double time) { return at_place(from + time * velocity); });
}

/// Contacts with objects that move, and of rods with each other.
inline std::unique_ptr<Contacts> contacts_with_moving(
    std::vector<MovingObstacle> obstacles,
    std::optional<double> friction_coefficient = std::nullopt,
    const EnvironmentContact::Options& options = {},
    const std::shared_ptr<const Environment>& environment = nullptr) {
  std::vector<std::unique_ptr<ContactSource>> sources;
  sources.push_back(std::make_unique<FiberContact>(FiberContact::Options{}));
  if (environment != nullptr) {
    sources.push_back(std::make_unique<EnvironmentContact>(environment, options));
  }
  const std::uint32_t still =
      environment == nullptr ? 0 : static_cast<std::uint32_t>(environment->objects().size());
  const auto motions = std::make_shared<ObstacleMotions>(std::move(obstacles), still);
  sources.push_back(std::make_unique<MovingObstacleContact>(motions, options));
  std::unique_ptr<Friction> friction;
  if (friction_coefficient) {
    friction = std::make_unique<Friction>(Friction::Options{*friction_coefficient, 1e-3});
  }
  return std::make_unique<Contacts>(std::move(sources), std::move(friction), motions);
}

}  // namespace fiber
