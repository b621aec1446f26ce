#include "validation/sim/strips.hpp"

#include <cmath>
#include <memory>
#include <utility>

#include "fiber_proximity/sim/loads.hpp"
#include "validation/sim/rod_scene.hpp"

namespace fiber {

using Eigen::Vector3d;

RodSection strip(double ratio) { return {1e5, 1.0, 0.8, 1.0, 1e-4, ratio}; }

Rods strip_of(const RodSection& section) {
  Rods rods;
  rods.add(straight({0, 0, 0}, {1, 0, 0}, strip_edges), 0.01, section);
  return rods;
}

StripScene strip_scene(Rods rods, const Vector3d& side, const Vector3d& force) {
  StripScene made{std::move(rods), {}};
  made.effects = effects(std::make_unique<Stretch>(), std::make_unique<Bend>(),
                         std::make_unique<Twist>(made.rods));
  if (side != Vector3d::Zero()) {
    made.rods.set_stiff_side(0, side);
    made.effects.push_back(std::make_unique<AnisotropicBend>());
  }
  auto loads = std::make_unique<Loads>();
  Loads::Load load;
  load.node = strip_edges;
  load.force = TimeTable<Vector3d>(force);
  loads->add(made.rods, load);
  made.effects.push_back(std::move(loads));
  made.effects.push_back(
      hold(made.rods, {clamp(0, {Vector3d::Zero(), Vector3d::UnitX(), made.rods.directors[0]})}));
  return made;
}

Vector3d settled_tip(StripScene scene) {
  Stepper stepper(scene.rods, std::move(scene.effects), precise());
  settle(stepper);
  return stepper.rods().positions[strip_edges];
}

StripDeflection simulated_strip(double angle) {
  constexpr double force = 1e-3;
  const Vector3d side(0.3, std::cos(angle),
                      std::sin(angle));  // what is along the rod is left out
  const Vector3d stiff(0.0, std::cos(angle), std::sin(angle));
  const Vector3d soft(0.0, -std::sin(angle), std::cos(angle));
  const Vector3d tip =
      settled_tip(strip_scene(strip_of(strip(strip_ratio)), side, force * (stiff + soft)));
  return {tip.dot(stiff) / (force / 3.0), tip.dot(soft) / (force / 3.0)};
}

}  // namespace fiber
