#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

/// Settings of a measurement of engines on the moving frames of a scene.
struct MeasurementOptions {
  std::string scene = "soup";
  SceneOptions scene_options;
  std::uint32_t copies = 1;                      ///< of the scene, side by side, at least 1
  std::vector<std::string> engines{"run_tree"};  ///< and peers
  std::uint32_t threads = 1;                     ///< most an engine may use, at least 1
  std::uint32_t repeats = 1;                     ///< frames to measure, at least 1
  bool detect_every_frame = true;                ///< false: only in the last frame
  bool swap = false;     ///< in every other frame fibres stand where others stood
  bool closest = false;  ///< detection finds the closest pair even if there is no contact
};

/// Times of one engine: medians over the frames [ms], work and pairs of the last frame.
struct EngineMeasurement {
  std::string engine;
  std::uint32_t threads = 1;  ///< it used
  double update_ms = 0.0;
  double detect_ms = 0.0;
  double cycle_ms = 0.0;
  double device_ms = 0.0;        ///< of that on a GPU, without what goes over and back
  std::size_t memory_bytes = 0;  ///< the engine holds, the fibres apart
  std::size_t pairs = 0;
  QueryCounts counts;
};

struct Measurement {
  std::size_t fibers = 0;
  std::size_t points = 0;
  std::size_t segments = 0;
  double memcpy_ms = 0.0;  ///< median time to copy the points
  std::vector<EngineMeasurement> engines;
  std::string disagreement;  ///< where two engines' pairs differ; empty when none do
};

/// Measures all engines in one run, frame by frame in turns, so that what slows the machine down
/// for a while slows all of them. Which one goes first changes from frame to frame.
/// @throws std::invalid_argument for unknown names and bad options
Measurement measure(const MeasurementOptions& options);

}  // namespace fiber
