#include "src/ros/detection/motion_detector.hpp"

#include <ros/console.h>

#include <stdexcept>
#include <utility>

#include "src/ros/detection/detector.hpp"

namespace fiber_proximity_ros {

void MotionDetector::take(InputSet& fibers, bool keeps_fibers) {
  FiberState newest;
  newest.has_fibers = keeps_fibers && fibers.is_fresh();
  for (const std::unique_ptr<Input>& input : fibers.inputs()) {
    newest.stamps.push_back(input->is_fresh() ? std::optional(input->stamp()) : std::nullopt);
  }
  newest.stamp = fibers.header().stamp;
  newest.uncertainties = fibers.uncertainties();
  if (newest.has_fibers) {
    newest.message = fibers.message();
  }
  step_.advance(std::move(newest));
}

std::optional<KnownMotion> MotionDetector::detect(const fiber::QueryOptions& options,
                                                  bool reports_all, double tolerance,
                                                  Budget& budget) {
  std::optional<KnownMotion> motion;
  if (step_.is_motion() && !budget.allows(Stage::MOTION)) {
    // Not told to the log, which takes longer than some deadlines: /diagnostics and statistics say
    // it.
    step_.pass_over(no_time_text(options));
    return motion;
  }
  if (step_.is_motion()) {
    try {
      budget.enter(Stage::MOTION);
      motion.emplace(detect_motion_contacts(
          *engine_, {step_.motion(), step_.time(), tolerance, step_.uncertainties()}, options,
          reports_all, result_, budget));
    } catch (const std::invalid_argument& error) {
      step_.refuse(error.what());
    }
  }
  if (!step_.problem().empty()) {
    ROS_WARN_STREAM_THROTTLE(
        1.0, "continuous: " << step_.problem() << "; this answer is of its stamp alone");
  }
  return motion;
}

}  // namespace fiber_proximity_ros
