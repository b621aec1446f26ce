#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/sim/effects.hpp"
#include "fiber_proximity/sim/joints.hpp"
#include "test/sim/random_rods.hpp"
#include "validation/sim/contact_scenes.hpp"

namespace fiber::test {
inline RodSection section_of(double bending, double twisting = 1e-3) {
  return {2000.0, bending, twisting, 0.05, 1e-6};
}

/// What a scene of joined rods calls for.
struct JointScene {
  bool has_twist = false;
  bool is_inextensible = false;
  double relaxation_time = 0.0;
  Integrator integrator = Integrator::IMPLICIT_EULER;
};

inline std::vector<JointScene> joint_scenes() {
  return {{false, false, 0.0, Integrator::IMPLICIT_EULER},
          {true, false, 0.0, Integrator::IMPLICIT_EULER},
          {false, true, 0.01, Integrator::BDF2},
          {true, false, 0.01, Integrator::BDF2}};
}

inline Effects effects_of(Rods& rods, const JointScene& scene) {
  Effects all = effects(std::make_unique<Bend>(),
                        std::make_unique<Gravity>(Eigen::Vector3d(0.0, 0.0, -standard_gravity)));
  if (scene.is_inextensible) {
    all.push_back(std::make_shared<Inextensible>(rods));
  } else {
    all.push_back(std::make_shared<Stretch>());
  }
  if (scene.has_twist) {
    all.push_back(std::make_shared<Twist>(rods));
  }
  if (scene.relaxation_time > 0.0) {
    all.push_back(std::make_shared<Damping>(scene.relaxation_time, !scene.has_twist));
  }
  return all;
}

inline std::unique_ptr<Joints> joints_of(const JointScene& scene) {
  return std::make_unique<Joints>(
      Joints::Options{true, std::make_shared<Damping>(scene.relaxation_time)});
}

/// Points of a fibre that is bent, and moves.
inline std::vector<Eigen::Vector3d> bent(int segments) {
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i <= segments; ++i) {
    const double s = static_cast<double>(i) / segments;
    points.emplace_back(s, 0.1 * std::sin(3.0 * s), 0.15 * s * s);
  }
  return points;
}

inline Eigen::Vector3d velocity_at(const Eigen::Vector3d& point) {
  return {0.3 * point.y(), 0.5 * point.x() - 0.2, std::cos(4.0 * point.x())};
}

inline void throw_rods(Rods& rods) {
  for (std::size_t i = 0; i < rods.positions.size(); ++i) {
    rods.velocities[i] = velocity_at(rods.positions[i]);
    if (!rods.spins.empty()) {
      rods.spins[i] = 3.0 * rods.positions[i].x();
    }
  }
}

inline StepperOptions options_of(const JointScene& scene) {
  StepperOptions options = precise(scene.integrator);
  options.residual = scene.is_inextensible ? 1e-8 : options.residual;
  return options;
}

/// [m] Edges that keep their lengths to 1e-6 lead a rod astray by the root of that.
inline double allowed_difference(const JointScene& scene) {
  return scene.is_inextensible ? 2e-3 : 1e-7;
}

/// A hold of a node where it is.
inline Attachment::Hold pin_of(const Rods& rods, std::uint32_t rod, std::uint32_t node) {
  Attachment::Hold held = pin(node, rods.positions[rods.first(rod) + node]);
  held.rod = rod;
  return held;
}

/// Three branches of different lengths and weights from one point: Y.
inline Rods branches(double scale = 1.0) {
  Rods rods;
  rods.add(straight({0.0, 0.0, 0.0}, {0.0, 0.0, 0.5 * scale}, 6), 0.004, section_of(0.02));
  rods.add(straight({0.3 * scale, 0.1, -0.2}, {0.0, 0.0, 0.0}, 5), 0.004, section_of(0.01));
  rods.add(straight({0.0, 0.0, 0.0}, {-0.2 * scale, 0.0, -0.4}, 8), 0.003, section_of(0.005));
  return rods;
}

inline Joints::Joint branching(Joints::Kind kind) { return {kind, {{0, 0}, {1, 5}, {2, 0}}}; }

}  // namespace fiber::test
