#pragma once

#include <Eigen/Core>
#include <array>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// How the first end of a cable is held: not, in its place, or in its place and direction.
enum class CableEnd { FREE, PINNED, CLAMPED };

/// A scene for all simulators: straight cables that are let go at time 0, at rest.
struct CableScene {
  static constexpr double step = 1.0 / 240.0;  ///< [s]
  static constexpr double gravity = 9.81;      ///< [m/s²] along -z

  std::string name;
  double seconds = 1.0;  ///< to simulate
  double radius = 0.01;  ///< [m]
  RodMaterial material;
  CableEnd first_end = CableEnd::FREE;
  double fading = 0.0;    ///< of its speed a mass loses this in a second [1/s]
  bool touches = false;   ///< cables touch each other and a floor, z = 0
  double friction = 0.0;  ///< coefficient
  std::vector<std::array<Eigen::Vector3d, 2>> cables;  ///< their ends [m]

  RodSection section() const { return solid_round_section(material, radius); }
  double length() const { return (cables.front()[1] - cables.front()[0]).norm(); }  ///< [m] of each
  int steps() const;

  /// By which a speed is multiplied after a step.
  /// @param length of the step [s]
  double fade(double length) const;
};

/// A limp rope of 1 m that swings from a pin, let go 45° below the level: too limp for its bending
/// stiffness to matter, so that those may take part that have none.
CableScene hanging_cable();

/// A hose of 1 m, level from a clamp, that comes to rest under its own weight.
CableScene cantilever_cable();

/// Ropes of 1 m in two layers across each other that fall on a floor.
CableScene falling_cables(int count);

/// Cables as a simulator has them.
class CableSimulation {
 public:
  CableSimulation() = default;
  CableSimulation(const CableSimulation&) = delete;
  CableSimulation& operator=(const CableSimulation&) = delete;
  virtual ~CableSimulation() = default;

  /// By CableScene::step.
  /// @throws std::runtime_error where the simulator gives up
  virtual void step() = 0;

  /// Cable by cable, one node more than segments each [m].
  virtual std::vector<Eigen::Vector3d> positions() = 0;
};

/// A simulator with its settings.
struct CableMethod {
  std::string method;
  std::string setting;  ///< in words
  int segments;         ///< of each cable
  std::function<std::unique_ptr<CableSimulation>(const CableScene&)> make;
};

}  // namespace fiber
