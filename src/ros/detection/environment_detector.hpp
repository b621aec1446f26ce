#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/observed_scene.hpp"
#include "src/ros/detection/step_contacts.hpp"

namespace fiber_proximity_ros {

/// Finds contacts of the fibres with what is around them.
class EnvironmentDetector {
 public:
  /// @param scene must outlive this
  explicit EnvironmentDetector(ObservedScene& scene)
      : scene_(scene), environment_(scene.environment.environment()) {}

  /// Finds contacts and, if wanted, the closest pair. Once at most after each update of the scene.
  /// @param step       since the answer before, if contacts in between can be found; it must live,
  ///                   unchanged, as long as motion() is used
  /// @param is_tracked whether contacts in between are wanted: they can be found if they were in
  ///                   the answer before, too
  /// @param budget     of the answer, in whose stage ENVIRONMENT this is done
  void detect(const fiber::QueryOptions& options, bool wants_minimum, const ContinuousStep* step,
              bool is_tracked, Budget& budget);

  /// An answer is given without looking around.
  void skip() { is_tracked_ = false; }

  // These are about the last detect():
  const Detection& detection() const { return detection_; }
  /// Null if the answer is of its stamp alone.
  const KnownMotion* motion() const { return motion_ ? &*motion_ : nullptr; }
  /// Whether contacts in between were not looked for, as there was no time.
  bool is_motion_left_out() const { return is_motion_left_out_; }
  const fiber::Environment& environment() const { return *environment_; }
  double update_time() const { return update_time_; }  ///< [s] to bring it up to date
  double motion_time() const { return motion_time_; }  ///< [s] to find contacts in between

 private:
  void detect_motion(const fiber::QueryOptions& options, const fiber::AllowedPairs& allowed,
                     const MovingEnvironment& environment, const ContinuousStep& step,
                     Budget& budget);

  ObservedScene& scene_;
  std::shared_ptr<const fiber::Environment> environment_;
  Detection detection_;
  fiber::MotionResult motion_result_;
  std::optional<KnownMotion> motion_;
  bool is_tracked_ = false;  // the answer before was looked at
  bool is_motion_left_out_ = false;
  double update_time_ = 0.0;
  double motion_time_ = 0.0;
};

/// The names of the objects, by index.
std::vector<std::string> object_names(const fiber::Environment& environment);

}  // namespace fiber_proximity_ros
