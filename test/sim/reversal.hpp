#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <utility>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/joints.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {

/// Joints and closed rods as there were, as they are now. What they were bent and twisted by makes
/// no difference to how the centre of mass moves.
inline std::unique_ptr<Joints> joined_again(Rods& rods, const Joints& before) {
  auto joints = std::make_unique<Joints>(Joints::Options{true, std::make_shared<Damping>(0.01)});
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    if (rods.is_closed(rod)) {
      joints->close(rods, rod);
    }
  }
  for (const Joints::Joint& joint : before.joints()) {
    joints->add(rods, joint);
  }
  return joints;
}

/// Rods that have come to lie somewhere, with nothing that holds them any more, and gravity turned
/// round: no holds, no friction, no drag. Where contacts lock, they stay.
class Reversal {
 public:
  /// @param rods        at the end of what has settled them
  /// @param contacts    with nothing above the rods, and without friction; null for none
  /// @param joints      of these rods; null for none
  Reversal(Rods rods, std::unique_ptr<Contacts> contacts, const StepperOptions& options,
           std::unique_ptr<Joints> joints = nullptr) {
    Effects effects = elastic(-standard_gravity);
    effects.push_back(std::make_unique<Damping>(0.01));
    if (!rods.angles.empty()) {
      effects.push_back(std::make_unique<Twist>(rods));
    }
    if (!rods.stiff_sides.empty()) {
      effects.push_back(std::make_unique<AnisotropicBend>());
    }
    for (Eigen::Vector3d& velocity : rods.velocities) {
      velocity.setZero();
    }
    for (double& spin : rods.spins) {
      spin = 0.0;
    }
    stepper_ = std::make_unique<Stepper>(std::move(rods), std::move(effects), options,
                                         std::move(contacts), std::move(joints));
  }

  /// Rises for some time [s], in steps of a length [s].
  void run(double time, double step) {
    const double start = height();
    double speed = 0.0;  // of what rises by gravity and obstacles alone
    double by_obstacles = 0.0;
    while (stepper_->time() < time - 0.5 * step) {
      stepper_->step(step);
      double force = 0.0;
      for (const RodForces::ContactForce& contact : stepper_->forces().contacts) {
        const bool is_obstacle = contact.other_rod == RodForces::ContactForce::obstacle;
        force += is_obstacle ? contact.normal_force.z() : 0.0;
        fiber_contacts_ += is_obstacle ? 0 : 1;
        obstacle_contacts_ += is_obstacle ? 1 : 0;
      }
      speed += step * force / mass();
      by_obstacles += step * speed;
    }
    // The height to which implicit Euler rises.
    free_ = 0.5 * standard_gravity * stepper_->time() * (stepper_->time() + step);
    rise_ = height() - start;
    by_obstacles_ = by_obstacles;
  }

  /// The centre of mass has risen as it does without any contact, and by what obstacles have
  /// pushed.
  testing::AssertionResult has_risen() const {
    const double tolerance = 0.02 * free_;
    if (rise_ >= free_ - tolerance && std::abs(rise_ - free_ - by_obstacles_) <= tolerance) {
      return testing::AssertionSuccess();
    }
    return testing::AssertionFailure()
           << "it has risen by " << rise_ << " m, freely these are " << free_ << " m, and "
           << by_obstacles_ << " m by what obstacles have pushed";
  }

  /// Seen in all steps together.
  int fiber_contacts() const { return fiber_contacts_; }
  int obstacle_contacts() const { return obstacle_contacts_; }

 private:
  double mass() const {
    double mass = 0.0;
    for (const double m : stepper_->rods().masses) {
      mass += m;
    }
    return mass;
  }

  double height() const {
    double height = 0.0;
    for (std::size_t i = 0; i < stepper_->rods().positions.size(); ++i) {
      height += stepper_->rods().masses[i] * stepper_->rods().positions[i].z();
    }
    return height / mass();
  }

  std::unique_ptr<Stepper> stepper_;
  double rise_ = 0.0;          // [m]
  double free_ = 0.0;          // [m]
  double by_obstacles_ = 0.0;  // [m]
  int fiber_contacts_ = 0;
  int obstacle_contacts_ = 0;
};

}  // namespace fiber::test
