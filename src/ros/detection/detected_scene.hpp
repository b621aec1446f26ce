#pragma once

#include <tbb/task_arena.h>

#include "fiber_proximity/query/options.hpp"
#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/environment_detector.hpp"
#include "src/ros/detection/fiber_step.hpp"
#include "src/ros/detection/observed_scene.hpp"

namespace fiber_proximity_ros {

/// The observed scene and what has been found in it: what outputs and services report. All of it
/// must outlive who holds this.
struct DetectedScene {
  ObservedScene& scene;
  Detector& detector;  ///< knows the fibres of the scene
  const EnvironmentDetector& environment;
  const FiberStep& step;  ///< of the fibres, from the answer before to the newest one
  const fiber::QueryOptions& query;
  tbb::task_arena& threads;  ///< of all that is asked
};

}  // namespace fiber_proximity_ros
