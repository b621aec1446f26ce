#pragma once

#include <ros/time.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/TimeToContact.h"
#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/geometry/point_velocities.hpp"
#include "src/ros/detection/budget.hpp"
#include "src/ros/detection/object_forecast.hpp"
#include "src/ros/detection/observed_scene.hpp"

namespace fiber_proximity_ros {

/// How predictions are made.
struct PredictionOptions {
  double horizon = 0.0;     ///< [s] how far ahead to look; 0: not at all
  std::size_t frames = 5;   ///< messages of each input from which velocities are found
  double tolerance = 1e-6;  ///< [m] see MotionOptions
};

/// Finds when fibres will touch each other, and what is around them, if all go on as they do.
class Predictor {
 public:
  /// @param scene must outlive this
  /// @throws std::invalid_argument as fiber::make_engine()
  Predictor(ObservedScene& scene, const std::string& engine, const fiber::EngineOptions& options)
      : scene_(scene), engine_(fiber::make_engine(engine, options)) {}

  void configure(const PredictionOptions& options);

  bool is_on() const { return options_.horizon > 0.0; }

  /// Takes the new fibres and tells what they are about to touch.
  /// @param budget of the answer, in whose stage PREDICTION this is done, if there is time
  void predict(const fiber::QueryOptions& options, fiber_proximity::TimeToContact& message,
               Budget& budget);

  /// Whether a deadline or a limit came before the end of the last prediction.
  bool is_cut_off() const { return is_cut_off_; }

  /// Nothing is looked at: velocities are not known any more.
  void skip() {
    inputs_frames_.clear();
    scene_.environment.keep_tracks(0);
  }

 private:
  /// The known motion of an input.
  struct InputFrames {
    fiber::PointVelocities velocities;
    // These are of the newest frame:
    std::vector<std::string> names;
    std::vector<std::uint32_t> offsets;
    std::optional<ros::Time> stamp;
  };

  void take_frames();
  bool predict_places(fiber_proximity::TimeToContact& message);
  std::optional<ObjectForecast> forecast_objects(fiber_proximity::TimeToContact& message) const;
  void find_contacts(const fiber::QueryOptions& options, fiber_proximity::TimeToContact& message,
                     Budget& budget);
  void find_contacts_of_fibers(const fiber::MotionOptions& asked, bool has_objects,
                               fiber_proximity::TimeToContact& message, Budget& budget);
  void find_contacts_with_objects(const fiber::MotionOptions& asked, const ObjectForecast& objects,
                                  fiber_proximity::TimeToContact& message, Budget& budget);
  void limit_to_known(const fiber::QueryOptions& options, fiber_proximity::TimeToContact& message);

  ObservedScene& scene_;
  std::unique_ptr<fiber::ProximityEngine> engine_;
  PredictionOptions options_;
  bool is_cut_off_ = false;
  std::string left_out_;                    // what the last prediction did not look at, and why
  std::vector<InputFrames> inputs_frames_;  // by input

  // Members for their memory.
  std::vector<Eigen::Vector3d> velocities_;  // [m/s]
  std::vector<Eigen::Vector3d> points_;      // [m] at the horizon
  fiber::FiberAssembly before_;
  fiber::FiberAssembly after_;
  std::shared_ptr<const fiber::Environment> around_;
  fiber::MotionResult result_;
};

}  // namespace fiber_proximity_ros
