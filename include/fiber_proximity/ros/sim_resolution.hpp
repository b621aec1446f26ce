#pragma once

#include <optional>

#include "fiber_proximity/ros/sim_fibers.hpp"
#include "fiber_proximity/sim/stepper.hpp"

namespace fiber_proximity_ros {

/// The finest a scene may be, whether it says so itself or by an accuracy.
constexpr std::int64_t most_substeps = 1000;

/// How a scene is cut into segments and steps.
struct SimResolution {
  std::vector<SimFiber> fibers;
  std::uint32_t substeps = 4;      ///< of a frame
  std::optional<double> accuracy;  ///< by which what the scene leaves open was chosen, relative
};

/// What a choice depends on.
struct SimSteps {
  double time_step;                       ///< of a frame [s]
  std::optional<std::uint32_t> substeps;  ///< as the scene gives them
  fiber::StepperOptions options;
  double gravity;  ///< [m/s²]
  bool has_contacts;
};

/// Reads the fibres of a scene and its keys `accuracy` (a number, or one with %) and `real_time`
/// (true): with one of these, segments of fibres and substeps that the scene does not give are
/// chosen by fiber::ResolutionTable: as few as are that accurate, or the most accurate that are
/// estimated to take at most half of the time there is.
/// @param document the scene
/// @throws std::invalid_argument naming file, line, field and value, and what is allowed; for an
///         accuracy that takes more substeps or segments than there may be, too
SimResolution read_sim_resolution(const YamlField& document, const SimSteps& steps);

}  // namespace fiber_proximity_ros
