#pragma once

#include <ros/node_handle.h>

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/TimeToContact.h"
#include "fiber_proximity/query/engine.hpp"
#include "src/geometry/point_velocities.hpp"
#include "src/ros/detection/knowledge.hpp"
#include "src/ros/inputs/input_set.hpp"
#include "src/ros/outputs/environment_output.hpp"

namespace fiber_proximity_ros {

/// How predictions are made.
struct PredictionOptions {
  double horizon = 0.0;     ///< [s] how far ahead to look; 0: not at all
  std::size_t frames = 5;   ///< messages of each input from which velocities are found
  double tolerance = 1e-6;  ///< [m] see MotionOptions
};

/// When fibres will touch if they go on as they do, on ~time_to_contact; nothing is computed unless
/// somebody listens.
class PredictionOutput {
 public:
  /// @param inputs must outlive this
  /// @throws std::invalid_argument as fiber::make_engine()
  PredictionOutput(ros::NodeHandle& private_node, InputSet& inputs, const std::string& engine,
                   const fiber::EngineOptions& options, const Newcomer& on_newcomer);

  void configure(const PredictionOptions& options);

  bool is_wanted() const { return options_.horizon > 0.0 && publisher_.getNumSubscribers() > 0; }

  /// Takes the new fibres and publishes what they are about to touch.
  /// @param environment what is around them, if there is anything
  void publish(const fiber::QueryOptions& options, const EnvironmentOutput& environment,
               const Knowledge& knowledge);

  /// Fibres are not looked at: their velocities are not known any more.
  void skip() { inputs_frames_.clear(); }

 private:
  /// What is known of an input's motion.
  struct InputFrames {
    fiber::PointVelocities velocities;
    // Of the newest frame:
    std::vector<std::string> names;
    std::vector<std::uint32_t> offsets;
    std::optional<ros::Time> stamp;
  };

  void take_frames();
  bool predict_places();
  void predict(const fiber::QueryOptions& options, const EnvironmentOutput& environment);
  void limit_to_known(const fiber::QueryOptions& options, const Knowledge& knowledge);

  InputSet& inputs_;
  ros::Publisher publisher_;
  std::unique_ptr<fiber::ProximityEngine> engine_;
  PredictionOptions options_;
  std::vector<InputFrames> inputs_frames_;  // by input

  // Members for their memory.
  std::vector<Eigen::Vector3d> velocities_;  // [m/s]
  std::vector<Eigen::Vector3d> points_;      // [m] at the horizon
  fiber::FiberAssembly before_;
  fiber::FiberAssembly after_;
  fiber::MotionResult result_;
  fiber_proximity::TimeToContact message_;
};

}  // namespace fiber_proximity_ros
