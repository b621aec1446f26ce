#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "fiber_proximity/sim/scene/scene.hpp"
#include "src/python/arrays.hpp"
#include "src/python/fibers.hpp"

namespace fiber::python {

/// A scene that moves. One thread at a time works with it, others wait; all without Python's lock.
class Simulation : public OnlyShared {
 public:
  /// @param threads most to use, 0 for as many as there are cores
  /// @throws std::invalid_argument as make_sim_scene(), and for what follows a frame of tf
  Simulation(SimDescription description, std::uint32_t threads);

  /// Moves on by as many frames.
  /// @throws std::runtime_error where it diverges; from then on all but reset() throws
  void step(std::uint32_t frames);

  /// Begins again.
  void reset();

  /// A copy of the scene as it is.
  /// @throws std::runtime_error if a step has failed
  SimScene copy() const;

  /// Calls with the scene and returns what that returns.
  /// @throws std::runtime_error if a step has failed
  template <class Call>
  auto with(const Call& call) const {
    const WithoutPythonLock others_may_run;
    const std::lock_guard<std::mutex> lock(mutex_);
    require_running();
    return call(scene_);
  }

 private:
  void require_running() const;

  const SimDescription description_;
  const std::uint32_t threads_;
  mutable std::mutex mutex_;  // guards what follows
  mutable SimScene scene_;
  std::string failure_;  // of a step; empty if none has failed
};

/// The hold of a node: a pin, or a clamp where it has a tangent.
struct HoldRequest {
  Eigen::Vector3d target;                   ///< [m]
  double speed = 0.0;                       ///< [m/s] with which it goes there; 0: within a step
  std::optional<Eigen::Vector3d> tangent;   ///< of unit length
  std::optional<Eigen::Vector3d> director;  ///< of unit length, across it
  double max_force = 0.0;                   ///< [N] 0: by the material
};

/// Holds a node, in place of what holds it.
/// @throws std::invalid_argument as require_reach() and Attachment::add()
void attach(SimScene& scene, std::uint32_t rod, std::int64_t node, const HoldRequest& request);

/// The rod of a fibre by its name or, without one, its index, which may count from the end.
/// @throws std::invalid_argument naming a fibre that is not there
std::uint32_t find_fiber(const SimScene& scene, const std::string& name, std::int64_t index);

/// A name or an index of a fibre.
/// @throws py::type_error for what is neither
std::pair<std::string, std::int64_t> fiber_argument(const py::object& fiber);

/// Simulation.predict of Python, and what it says of itself.
extern const char* const predict_doc;
py::dict predict(const Simulation& simulation, double duration, const py::list& trajectories,
                 double sample_period, double margin);

/// Adds what forces are made of.
void bind_forces(py::module& module);

/// The forces of a scene, as Python has them.
py::object forces_of(const Simulation& simulation);

}  // namespace fiber::python
