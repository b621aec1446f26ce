#pragma once

#include <ros/node_handle.h>

#include <functional>
#include <string>
#include <vector>

#include "fiber_proximity/FiberArray.h"
#include "fiber_proximity/TimeToContact.h"
#include "src/ros/detection/budget.hpp"
#include "src/ros/detection/detected_scene.hpp"
#include "src/ros/detection/detector.hpp"
#include "src/ros/detection/environment_detector.hpp"
#include "src/ros/detection/motion_detector.hpp"
#include "src/ros/detection/observed_scene.hpp"
#include "src/ros/detection/predictor.hpp"
#include "src/ros/outputs/answer_text.hpp"
#include "src/ros/outputs/comparison_output.hpp"
#include "src/ros/outputs/contact_output.hpp"
#include "src/ros/outputs/crossings_output.hpp"
#include "src/ros/outputs/marker_output.hpp"
#include "src/ros/outputs/node_reports.hpp"
#include "src/ros/outputs/output_topic.hpp"
#include "src/ros/server/server_options.hpp"
#include "src/ros/server/settings.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

/// The reason for an answer.
struct AnswerCause {
  bool has_new_fibers;  ///< false: about the same fibres as the answer before
  bool shows_fibers;    ///< whether ~fibers and ~crossings are published, too
  double time_before;   ///< [s] that messages have taken before
  Stopwatch stopwatch;  ///< of all else
};

/// Takes the observed scene through detection to all topics of results. What nobody subscribes to
/// is not computed.
class AnswerPipeline {
 public:
  /// All of these must outlive it.
  /// @param on_newcomer   called when somebody begins to listen
  /// @param before_answer called before ~compare is answered, to take in what has arrived
  /// @throws std::invalid_argument for a bad parameter
  AnswerPipeline(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                 const ServerOptions& options, const Settings& settings, ObservedScene& scene,
                 const Newcomer& on_newcomer, const std::function<void()>& before_answer);

  /// Gives an answer about all of the scene.
  void answer(const AnswerCause& cause);

  /// Gives an answer about what is around the fibres, which has changed while they have not.
  void answer_about_environment();

  /// Does what is due whether or not messages arrive: late markers and diagnostics.
  void tick();

  DetectedScene detected() {
    return {scene_, detector_, environment_, motion_.step(), settings_.query(), threads_};
  }

 private:
  void begin();
  void add_part(const std::string& name, double seconds, bool is_complete = true);
  void tell_pairs();
  std::vector<Stage> planned_stages(bool wants_contacts, bool looks_around) const;
  void publish_fibers();
  void detect();
  void publish_contacts();
  void detect_in_environment();
  void predict();
  void compare();
  bool publish_markers_if_due();
  Completeness completeness_of_all() const;

  const Settings& settings_;
  ObservedScene& scene_;
  tbb::task_arena threads_;  // of all that has no engine
  Detector detector_;
  MotionDetector motion_;
  EnvironmentDetector environment_;
  Predictor predictor_;
  OutputTopic<fiber_proximity::FiberArray> fibers_;
  ContactOutput contacts_;
  ContactOutput environment_contacts_;
  CrossingsOutput crossings_;
  OutputTopic<fiber_proximity::TimeToContact> time_to_contact_;
  MarkerOutput markers_;
  ComparisonOutput comparison_;
  StatisticsOutput statistics_;
  Answer answer_;           // the last one
  bool is_around_ = false;  // something, at the last look
  Budget budget_;
  Diagnostics diagnostics_;
};

}  // namespace fiber_proximity_ros
