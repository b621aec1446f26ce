#pragma once

#include <diagnostic_updater/diagnostic_updater.h>
#include <ros/node_handle.h>

#include <cstdint>
#include <map>
#include <string>

#include "fiber_proximity/Statistics.h"
#include "src/ros/detection/detected_scene.hpp"
#include "src/ros/outputs/answer_text.hpp"
#include "src/ros/outputs/output_topic.hpp"

namespace fiber_proximity_ros {

/// Sizes, times and accuracy of each answer, on ~statistics.
class StatisticsOutput {
 public:
  StatisticsOutput(const ros::NodeHandle& private_node, const DetectedScene& about,
                   const Newcomer& on_newcomer);

  bool has_listeners() const { return topic_.has_listeners(); }

  /// @param answer    its first part is the merging of inputs
  /// @param of_fibers how complete the contacts of fibres are, of all how complete all of it is
  void publish(const Answer& answer, const Completeness& of_fibers, const Completeness& of_all);

 private:
  DetectedScene about_;
  OutputTopic<fiber_proximity::Statistics> topic_;
};

/// Answers since the last report, and how many of them a deadline or a limit has cut off.
struct AnswerCounts {
  std::uint64_t answers = 0;
  std::uint64_t cut_off = 0;
  std::uint64_t late = 0;      ///< that took longer than their deadline
  std::uint64_t hopeless = 0;  ///< of which updates alone took longer
  std::string reason;          ///< of the last one that was
};

/// The node's entries on /diagnostics, each second: one per input and source of the environment,
/// one for the engine and one for deadlines and limits.
class Diagnostics {
 public:
  Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
              const DetectedScene& about);
  Diagnostics(const Diagnostics&) = delete;
  Diagnostics& operator=(const Diagnostics&) = delete;

  /// Counts an answer.
  /// @param cut_off why not all pairs of fibres were looked at; empty if they were
  void count(const Answer& answer, const std::string& cut_off);

  /// Publishes if it is time to.
  void update() { updater_.update(); }

 private:
  using Status = diagnostic_updater::DiagnosticStatusWrapper;

  /// The counts at the last report, for rates.
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

  DetectedScene about_;
  std::map<std::string, Seen> seen_;  // by topic
  AnswerCounts counts_;
  diagnostic_updater::Updater updater_;
};

}  // namespace fiber_proximity_ros
