#pragma once

#include <memory>
#include <optional>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "src/ros/detection/fiber_step.hpp"
#include "src/ros/detection/step_contacts.hpp"

namespace fiber_proximity_ros {

/// Finds contacts of the fibres with each other between the stamps of two answers.
class MotionDetector {
 public:
  /// @param longest_motion see FiberStep
  /// @throws std::invalid_argument as fiber::make_engine()
  MotionDetector(const std::string& engine, const fiber::EngineOptions& options,
                 double longest_motion)
      : engine_(fiber::make_engine(engine, options)), step_(longest_motion) {}

  /// Takes the fibres of a new answer.
  /// @param keeps_fibers whether they are kept for the motion to the next ones
  void take(InputSet& fibers, bool keeps_fibers);

  /// An answer is given about the same fibres again, which have not moved since.
  void rest() { step_.rest(); }

  const FiberStep& step() const { return step_; }

  /// Finds what came into contact since the answer before.
  /// @param options     of the query whose contacts there are now
  /// @param reports_all see KnownMotion
  /// @param tolerance   [m] see fiber::MotionOptions
  /// @param budget      of the answer, in whose stage MOTION this is done, if there is time
  /// @returns nothing where that cannot be told, which the log is told, or the budget has no time
  ///          for it: the answer is of its stamp alone then. What it returns refers to this object,
  ///          until the next call
  std::optional<KnownMotion> detect(const fiber::QueryOptions& options, bool reports_all,
                                    double tolerance, Budget& budget);

 private:
  std::unique_ptr<fiber::ProximityEngine> engine_;
  FiberStep step_;
  fiber::MotionResult result_;
};

}  // namespace fiber_proximity_ros
