#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/Statistics.h"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/inputs/input_set.hpp"
#include "src/ros/outputs/detector.hpp"
#include "src/ros/outputs/environment_output.hpp"
#include "src/ros/outputs/fiber_step.hpp"

namespace fiber_proximity_ros {

/// Sizes, times and accuracy of each answer, on ~statistics.
class StatisticsOutput {
 public:
  /// What they are about; all must outlive the output.
  struct Subject {
    const std::string& engine;
    InputSet& inputs;
    const Detector& detector;
    const EnvironmentOutput& environment;
    const FiberStep& step;
  };

  StatisticsOutput(ros::NodeHandle& private_node, const Subject& about);

  bool has_listeners() const { return publisher_.getNumSubscribers() > 0; }

  /// Forgets the parts of the answer before.
  void begin() { parts_.clear(); }

  /// What an answer has run, and how long it took [s]. The first part is the merging of inputs.
  void add_part(const std::string& name, double seconds);

  /// @param time [s] of all parts but the first, with conversions
  void publish(fiber::Kernel kernel, double time);

 private:
  Subject about_;
  ros::Publisher publisher_;
  std::vector<std::pair<std::string, double>> parts_;
  fiber_proximity::Statistics message_;  // for its memory
};

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
