#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "fiber_proximity/Statistics.h"
#include "fiber_proximity/query/options.hpp"
#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/fiber_step.hpp"
#include "src/ros/detection/knowledge.hpp"
#include "src/ros/inputs/input_set.hpp"
#include "src/ros/outputs/environment_output.hpp"
#include "src/ros/support/advertise.hpp"

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

  StatisticsOutput(ros::NodeHandle& private_node, const Subject& about,
                   const Newcomer& on_newcomer);

  bool has_listeners() const { return publisher_.getNumSubscribers() > 0; }

  /// Forgets the parts of the answer before.
  void begin() { parts_.clear(); }

  /// What an answer has run, and how long it took [s]. The first part is the merging of inputs.
  void add_part(const std::string& name, double seconds);

  /// @param of_fibers how complete the contacts of fibres are, of all how complete all of it is
  /// @param time      [s] of all of it, with conversions
  void publish(fiber::Kernel kernel, const Completeness& of_fibers, const Completeness& of_all,
               double time);

 private:
  Subject about_;
  ros::Publisher publisher_;
  std::vector<std::pair<std::string, double>> parts_;
  fiber_proximity::Statistics message_;  // for its memory
};

/// Answers since the last report, and how many of them a deadline or a limit has cut off.
struct AnswerCounts {
  std::uint64_t answers = 0;
  std::uint64_t cut_off = 0;
  std::string reason;  ///< of the last one that was
};

/// The node's entries on /diagnostics, each second: one per input and source of the environment,
/// one for the engine and one for deadlines and limits.
class Diagnostics {
 public:
  /// What they are about; all must outlive this.
  struct Subject {
    const InputSet& inputs;
    const EnvironmentInputs& environment;
    const Knowledge& knowledge;
    const Detector& detector;
    const fiber::QueryOptions& options;
  };

  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const Subject& about);
  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

  /// Counts an answer.
  /// @param cut_off why not all pairs were looked at; empty if they were
  void count(const std::string& cut_off);

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
  void report_source(const std::string& source, Status& status);
  void report_engine(Status& status) const;
  void report_deadlines(Status& status);
  void add_counts(const fiber_proximity::InputStatistics& input, Status& status);

  Subject about_;
  std::map<std::string, Seen> seen_;  // by topic
  AnswerCounts counts_;
  diagnostic_updater::Updater updater_;
};

}  // namespace fiber_proximity_ros
