#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "fiber_proximity/scenes/scene.hpp"

namespace fiber {

/// Fibres of a scene that each go their own way (after_own_ways), and how far.
struct SceneMotionSettings {
  std::string scene;
  SceneOptions scene_options;
  double way = 1.0;            ///< of every point, in mean radii of segments
  std::uint32_t repeats = 11;  ///< motions to measure
};

/// The contacts that one way of looking between frames finds, and its time on one thread.
struct SceneMotionResult {
  std::string method;
  bool finds_all = true;
  std::uint32_t frames = 0;      ///< it was measured on; over all of these:
  std::uint64_t contacts = 0;    ///< of different fibres, certain, that begin between two frames
  std::uint64_t missed = 0;      ///< of these, by what finds all
  std::uint64_t candidates = 0;  ///< pairs of segments that were examined
  double time_ms = 0.0;          ///< of a frame, median
  double times_discrete = 0.0;   ///< median of each frame's time in units of that of discrete_1
};

struct SceneMotionResults {
  std::size_t segments = 0;
  double radius = 0.0;  ///< [m] mean of segments
  std::vector<SceneMotionResult> methods;
};

/// In turns on the same frames: a look at all contacts at the end of each step (discrete_1), at the
/// ends of 10 and of 100 parts of it, each after an update; and at the motion, for all contacts
/// (motion_all) and for the first one (motion_first). Those that look several times are measured on
/// as many times fewer frames, on one at least.
/// @throws std::invalid_argument for an unknown scene or bad options
SceneMotionResults scene_motion_results(const SceneMotionSettings& settings);

}  // namespace fiber
