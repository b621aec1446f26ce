#include "src/ros/detection/environment_detector.hpp"

#include <ros/console.h>

#include <stdexcept>
#include <utility>

#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

void EnvironmentDetector::detect(const fiber::QueryOptions& options, bool wants_minimum,
                                 const ContinuousStep* step, bool is_tracked, Budget& budget) {
  const Stopwatch stopwatch;
  const std::shared_ptr<const fiber::Environment> before =
      std::exchange(environment_, scene_.environment.environment());
  update_time_ = scene_.environment_time + stopwatch.seconds();
  const fiber::AllowedPairs allowed = scene_.environment.allowed(scene_.fibers.names());
  const Uncertainty uncertainty(scene_.fibers.uncertainties(), Uncertainty::Bodies::A);
  budget.ask(options, [&](const fiber::QueryOptions& in_time) {
    detection_.detect(in_time, wants_minimum, uncertainty,
                      [&](const fiber::QueryOptions& asked, fiber::QueryResult& result) {
                        environment_->query(scene_.fibers.fibers(), asked, allowed, result);
                      });
  });
  if (const std::string problem = detection_.limit_problem(options); !problem.empty()) {
    ROS_WARN_STREAM_THROTTLE(1.0, "environment: " << problem);
  }
  motion_.reset();
  motion_time_ = 0.0;
  const bool was_tracked = std::exchange(is_tracked_, is_tracked);
  const bool is_asked = step != nullptr && was_tracked && is_tracked;
  is_motion_left_out_ = is_asked && !budget.allows(Stage::ENVIRONMENT_MOTION);
  if (is_asked && !is_motion_left_out_) {
    budget.enter(Stage::ENVIRONMENT_MOTION);
    detect_motion(options, allowed, {before, environment_}, *step, budget);
  }
}

void EnvironmentDetector::detect_motion(const fiber::QueryOptions& options,
                                        const fiber::AllowedPairs& allowed,
                                        const MovingEnvironment& environment,
                                        const ContinuousStep& step, Budget& budget) {
  const Stopwatch stopwatch;
  try {
    motion_.emplace(detect_motion_contacts(environment, allowed, step, options,
                                           detection_.has_all_of(options), motion_result_, budget));
    motion_time_ = stopwatch.seconds();
  } catch (const std::invalid_argument& error) {
    ROS_WARN_STREAM_THROTTLE(
        1.0, "environment, continuous: " << error.what() << "; this answer is of its stamp alone");
  }
}

std::vector<std::string> object_names(const fiber::Environment& environment) {
  std::vector<std::string> names;
  names.reserve(environment.objects().size());
  for (const fiber::EnvironmentObject& object : environment.objects()) {
    names.push_back(object.name);
  }
  return names;
}

}  // namespace fiber_proximity_ros
