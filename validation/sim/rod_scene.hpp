#pragma once

#include <Eigen/Geometry>
#include <cmath>
#include <memory>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/attachment.hpp"
#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// Effects in a list, which cannot be made from what cannot be copied.
template <class... E>
Effects effects(std::unique_ptr<E>... each) {
  Effects list;
  (list.push_back(std::move(each)), ...);
  return list;
}

/// Points from one to another at equal distances.
inline std::vector<Eigen::Vector3d> straight(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                             int segments) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    points.push_back(from + (to - from) * i / segments);
  }
  return points;
}

inline Attachment::Hold pin(std::uint32_t node, const Eigen::Vector3d& position) {
  return {0, node, Attachment::Kind::PIN, [position](double /*time*/) {
            return Placement{position, Eigen::Vector3d::Zero(), Eigen::Vector3d::Zero()};
          }};
}

inline Attachment::Hold clamp(std::uint32_t node, const Placement& placement) {
  return {0, node, Attachment::Kind::CLAMP, [placement](double /*time*/) { return placement; }};
}

inline std::unique_ptr<Attachment> hold(const Rods& rods,
                                        const std::vector<Attachment::Hold>& holds) {
  auto attachment = std::make_unique<Attachment>();
  for (const Attachment::Hold& each : holds) {
    attachment->add(rods, each);
  }
  return attachment;
}

/// Lets rods find their equilibrium: from rest in steps ever longer, until they have no inertia.
inline void settle(Stepper& stepper) {
  double moved = 1.0;
  double step = 0.05;
  for (int i = 0; i < 300 && (moved > 1e-11 || step < 100.0); ++i) {
    const std::vector<Eigen::Vector3d> before = stepper.rods().positions;
    stepper.step(step);
    step = std::min(100.0, 1.3 * step);
    moved = 0.0;
    for (std::size_t node = 0; node < before.size(); ++node) {
      moved = std::max(moved, (stepper.rods().positions[node] - before[node]).norm());
      stepper.rods().velocities[node].setZero();
    }
  }
}

/// Newton's method as far as rounding errors let it go, for what is compared with closed forms.
inline StepperOptions precise(Integrator integrator = Integrator::IMPLICIT_EULER) {
  StepperOptions options;
  options.integrator = integrator;
  options.residual = 1e-11;
  options.max_iterations = 30;
  options.threads = 1;
  return options;
}

}  // namespace fiber
