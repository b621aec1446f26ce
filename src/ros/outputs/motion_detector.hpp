#pragma once

#include <memory>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "src/ros/outputs/fiber_step.hpp"
#include "src/ros/outputs/step_contacts.hpp"

namespace fiber_proximity_ros {

/// Contacts of the fibres with each other in the step from one answer to the next, from an engine
/// that is there for motions.
class MotionDetector {
 public:
  /// @throws std::invalid_argument as fiber::make_engine()
  explicit MotionDetector(const std::string& engine, const fiber::EngineOptions& options = {})
      : engine_(fiber::make_engine(engine, options)) {}

  /// Finds what came into contact in the motion of a step. The step must live, unchanged, as long
  /// as what is found is used.
  /// @param options   of the query whose contacts there are now
  /// @param tolerance [m] see MotionOptions
  /// @throws std::invalid_argument for fibres that move too far, or that the engine cannot take
  void detect(const FiberStep& step, const fiber::QueryOptions& options, double tolerance);

  /// What the last detect() found.
  /// @param reports_all see KnownMotion
  KnownMotion known_motion(bool reports_all) const;
  const fiber::MotionResult& result() const { return result_; }

  double time() const { return time_; }  ///< [s] that it took

 private:
  void keep_earliest_of_fiber_pairs();

  std::unique_ptr<fiber::ProximityEngine> engine_;
  const FiberStep* step_ = nullptr;
  fiber::MotionOptions options_;
  fiber::MotionResult result_;
  double time_ = 0.0;
};

}  // namespace fiber_proximity_ros
