#pragma once

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

}  // namespace fiber_proximity_ros
