#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <vector>

#include "src/ros/inputs/input_set.hpp"
#include "src/ros/outputs/detector.hpp"

namespace fiber_proximity_ros {

/// The node's entries on /diagnostics: one per input and one for the engine, each second.
class Diagnostics {
 public:
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const InputSet& inputs, const Detector& detector);
  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

  /// Publishes if it is time to.
  void update() { updater_.update(); }

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// What was seen at the last report, for rates.
  struct Seen {
    ros::SteadyTime time = ros::SteadyTime::now();
    std::uint64_t received = 0;
    std::uint64_t refused = 0;
  };

  void report_input(std::size_t index, Status& status);
  void report_engine(Status& status);

  const InputSet& inputs_;
  const Detector& detector_;
  std::vector<Seen> seen_;
  diagnostic_updater::Updater updater_;
};

}  // namespace fiber_proximity_ros
