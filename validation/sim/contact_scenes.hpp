#pragma once

#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/stepper.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber {

constexpr double standard_gravity = 9.81;  // [m/s²]

inline RodSection rubber(double radius) { return solid_round_section({1e7, 4e6, 1200.0}, radius); }

/// Stretch, bend, and gravity along -z [m/s²] unless it is 0.
inline Effects elastic(double gravity = 0.0) {
  Effects effects;
  effects.push_back(std::make_unique<Stretch>());
  effects.push_back(std::make_unique<Bend>());
  if (gravity != 0.0) {
    effects.push_back(std::make_unique<Gravity>(Eigen::Vector3d(0.0, 0.0, -gravity)));
  }
  return effects;
}

/// One object of one shape.
inline std::shared_ptr<const Environment> environment_of(
    const Shape& shape, const Eigen::Isometry3d& pose = Eigen::Isometry3d::Identity()) {
  EnvironmentObject object;
  object.name = "obstacle";
  object.pose = pose;
  object.shapes.push_back({shape, Eigen::Isometry3d::Identity()});
  return std::make_shared<const Environment>(std::vector<EnvironmentObject>{object});
}

/// Contacts of the rods with each other, and with an environment unless that is null.
inline std::unique_ptr<Contacts> contacts_with(
    const std::shared_ptr<const Environment>& environment,
    std::optional<double> friction_coefficient = std::nullopt) {
  std::vector<std::unique_ptr<ContactSource>> sources;
  sources.push_back(std::make_unique<FiberContact>(FiberContact::Options{}));
  if (environment != nullptr) {
    sources.push_back(
        std::make_unique<EnvironmentContact>(environment, EnvironmentContact::Options{}));
  }
  std::unique_ptr<Friction> friction;
  if (friction_coefficient) {
    friction = std::make_unique<Friction>(Friction::Options{*friction_coefficient, 1e-3});
  }
  return std::make_unique<Contacts>(std::move(sources), std::move(friction));
}

inline Eigen::Vector3d momentum_of(const Rods& rods) {
  Eigen::Vector3d momentum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    momentum += rods.masses[i] * rods.velocities[i];
  }
  return momentum;
}

inline bool all_finite(const Rods& rods) {
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    if (!rods.positions[i].allFinite() || !rods.velocities[i].allFinite()) {
      return false;
    }
  }
  return true;
}

}  // namespace fiber
