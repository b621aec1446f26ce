#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// The cost and residual of the first steps of a scene, measured on a copy of it.
struct SimTrial {
  std::uint32_t steps = 0;
  double real_time_factor = 0.0;  ///< time of the scene by wall time
  std::uint32_t iterations = 0;   ///< of Newton's method, the most in a step
  double residual = 0.0;          ///< the largest of a step [m/s]
  std::string failure;    ///< why the scene does not get further than that; empty if it does
  double duration = 0.0;  ///< of the trial in wall time, the copy included [s]
};

/// Steps a scene made of a description for some frames or some tenths of a second, whichever is
/// less; one step at least.
/// @throws std::invalid_argument as make_sim_scene
SimTrial try_scene(const SimDescription& description, std::uint32_t threads);

/// The expected behaviour of a scene, in sentences.
struct SimReport {
  std::vector<std::string> facts;     ///< stability, damping, balance, speed, and the trial itself
  std::vector<std::string> warnings;  ///< problems, and their remedies
};

/// Warnings of what a scene leaves out but may have meant: contacts, resistance to stretch, values
/// of materials.
std::vector<std::string> omissions(const SimScene& scene);

/// Warns of omissions; judges steps against the waves that they resolve, grippers against the
/// radius, balance and speed by the trial.
SimReport report(const SimScene& scene, const SimTrial& trial);

/// A problem after a frame.
struct SimWarning {
  enum class Kind {
    STRAIN,    ///< an edge is stretched by more than `max_strain`
    LAG,       ///< a hold pulls with its greatest force and is not followed
    OBSTACLE,  ///< a moving obstacle is kept from its way
    BALANCE    ///< forces do not balance to `residual`; not of scenes that ask for few iterations
  };
  static constexpr std::size_t kinds = 4;

  Kind kind;
  std::string text;  ///< names fibre, place, value and limit
};

/// At most one of each kind: the worst.
std::vector<SimWarning> frame_warnings(const SimScene& scene);

}  // namespace fiber
