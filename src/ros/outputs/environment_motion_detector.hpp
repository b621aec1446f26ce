#pragma once

#include <memory>

#include "fiber_proximity/environment/environment.hpp"
#include "src/ros/outputs/step_contacts.hpp"

namespace fiber_proximity_ros {

/// A step of the fibres that is to be looked at as a motion.
struct ContinuousStep {
  fiber::FiberMotion motion;
  fiber::TimeBounds time;
  double tolerance;  ///< [m] see fiber::MotionOptions
};

/// Contacts of the fibres with what is around them in the step from one answer to the next.
class EnvironmentMotionDetector {
 public:
  /// Finds what came into contact. Objects move from where they were to where they are; those that
  /// were not there before, or had other shapes, as a point cloud does, count as standing still.
  /// @param before of the answer before
  /// @param options of the query whose contacts there are now
  /// @throws std::invalid_argument as fiber::Environment::query_motion()
  void detect(const ContinuousStep& step, const std::shared_ptr<const fiber::Environment>& before,
              std::shared_ptr<const fiber::Environment> now, const fiber::QueryOptions& options,
              const fiber::AllowedPairs& allowed);

  /// What the last detect() found; refers to its step.
  /// @param reports_all see KnownMotion
  KnownMotion known_motion(const ContinuousStep& step, bool reports_all) const;
  const fiber::MotionResult& result() const { return result_; }

 private:
  std::shared_ptr<const fiber::Environment> before_;  // its objects as in now_
  std::shared_ptr<const fiber::Environment> now_;
  double margin_ = 0.0;  // [m]
  fiber::MotionResult result_;
};

}  // namespace fiber_proximity_ros
