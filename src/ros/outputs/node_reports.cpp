#include "src/ros/outputs/node_reports.hpp"

#include <limits>
#include <optional>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::uint32_t to_count(std::size_t count) { return static_cast<std::uint32_t>(count); }

}  // namespace

StatisticsOutput::StatisticsOutput(const ros::NodeHandle& private_node, const DetectedScene& about,
                                   const Newcomer& on_newcomer)
    : about_(about), topic_(private_node, "statistics", on_newcomer) {}

void StatisticsOutput::publish(const Answer& answer, const Completeness& of_fibers,
                               const Completeness& of_all) {
  const auto& [scene, detector, environment, step, query, threads] = about_;
  fiber_proximity::Statistics& message = topic_.message();
  message.header = scene.fibers.header();
  message.engine = detector.engine_name();
  const fiber::FiberAssembly& fibers = scene.fibers.fibers();
  message.fibers = to_count(fibers.fiber_count());
  message.points = to_count(fibers.point_count());
  message.segments = to_count(fibers.segment_count());
  const Detection& found = detector.detection();
  message.contacts = to_count(found.contacts().contacts.size());
  message.minimum_distance = found.minimum() != nullptr ? found.minimum()->distance
                                                        : std::numeric_limits<double>::infinity();
  message.merge_time = answer.parts.front().seconds;
  message.update_time = detector.update_time();
  message.detect_time = detector.detect_time();
  message.total_time = answer.total_time;
  message.kernel = name_of(query.kernel);
  message.complete = of_all.is_complete();
  message.unknown = of_all.unknown();
  message.limit_reached = found.is_limit_reached();
  message.minimum_lower =
      of_fibers.lower(found.minimum_lower(), -std::numeric_limits<double>::infinity());
  message.minimum_upper = found.minimum_upper();
  message.contact_error = found.contact_error();
  message.node_tests = found.counts().node_tests;
  message.node_overlaps = found.counts().node_overlaps;
  message.primitive_tests = found.counts().primitive_tests;
  message.parts.clear();
  message.part_times.clear();
  message.part_complete.clear();
  for (const AnswerPart& part : answer.parts) {
    message.parts.push_back(part.name);
    message.part_times.push_back(part.seconds);
    message.part_complete.push_back(static_cast<std::uint8_t>(part.is_complete));
  }
  message.discrete_answers = step.problem_count();
  message.discrete_reason = step.problem();
  const bool is_alone = !scene.environment.is_used();
  message.objects = is_alone ? 0 : to_count(environment.environment().objects().size());
  message.environment_contacts =
      is_alone ? 0 : to_count(environment.detection().contacts().contacts.size());
  message.inputs.clear();
  for (const std::unique_ptr<Input>& input : scene.fibers.inputs()) {
    message.inputs.push_back(input->statistics(ros::Time::now()));
  }
  for (const auto& input : scene.environment.statistics(ros::Time::now())) {
    message.inputs.push_back(input);
  }
  message.summary = answer_text(answer);
  topic_.publish();
}

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const DetectedScene& about)
    : about_(about), updater_(node, private_node, private_node.getNamespace()) {
  updater_.setHardwareID("none");
  for (std::size_t i = 0; i < about_.scene.fibers.inputs().size(); ++i) {
    updater_.add("input " + about_.scene.fibers.inputs()[i]->options().topic,
                 [this, i](Status& status) { report_input(i, status); });
  }
  for (const std::string& source : about_.scene.environment.sources()) {
    updater_.add("environment " + source,
                 [this, source](Status& status) { report_source(source, status); });
  }
  updater_.add("engine", [this](Status& status) { report_engine(status); });
  updater_.add("deadlines and limits", [this](Status& status) { report_deadlines(status); });
}

void Diagnostics::count(const Answer& answer, const std::string& cut_off) {
  ++counts_.answers;
  const bool has_deadline = answer.deadline > 0.0;
  std::string reason = cut_off;
  for (const AnswerPart& part : answer.parts) {
    if (reason.empty() && has_deadline && !part.is_complete) {
      reason = cut_off_text(part.name, about_.query);
    }
  }
  if (!reason.empty()) {
    ++counts_.cut_off;
    counts_.reason = reason;
  }
  counts_.late += has_deadline && answer.total_time > answer.deadline ? 1 : 0;
  counts_.hopeless += has_deadline && update_time(answer) > answer.deadline ? 1 : 0;
}

/// Adds the counts of messages of a topic; the summary is worse where some were refused since the
/// last report.
void Diagnostics::add_counts(const fiber_proximity::InputStatistics& input, Status& status) {
  Seen now;
  now.received = input.received;
  now.refused = input.refused;
  const Seen before = std::exchange(seen_.try_emplace(input.topic).first->second, now);
  const double seconds = (now.time - before.time).toSec();
  if (now.refused > before.refused) {
    status.mergeSummary(DiagnosticStatus::ERROR, "messages refused: " + input.last_error);
  }
  status.add("type", input.type);
  status.addf("rate [Hz]", "%.1f", static_cast<double>(now.received - before.received) / seconds);
  status.addf("age [s]", "%.3f", input.age);
  status.add("received", input.received);
  status.add("refused", input.refused);
  status.add("overtaken", input.overtaken);
  status.add("last error", input.last_error);
}

void Diagnostics::report_input(std::size_t index, Status& status) {
  const Input& source = *about_.scene.fibers.inputs()[index];
  const fiber_proximity::InputStatistics input = source.statistics(ros::Time::now());
  const std::optional<Unknown> unknown = source.unknown();
  if (input.stale) {
    status.summary(source.options().required ? DiagnosticStatus::ERROR : DiagnosticStatus::WARN,
                   "stale: " + source.stale_reason());
  } else if (unknown) {
    status.summary(DiagnosticStatus::WARN, unknown->why);
  } else {
    status.summary(DiagnosticStatus::OK, input.age < 0.0 ? "no message yet" : "receiving");
  }
  add_counts(input, status);
  status.add("fibres", input.fibers);
  status.add("dropped", input.dropped < 0 ? "unknown" : std::to_string(input.dropped));
  status.add("missing points", input.missing_points);
  status.add("missing fibres", input.missing_fibers);
  status.add("lone points", input.lone_points);
}

/// A source of the environment: robot, scene or a topic.
void Diagnostics::report_source(const std::string& source, Status& status) {
  std::vector<std::string> unknown;
  for (const Unknown& each : about_.scene.knowledge.unknown_objects()) {
    if (each.source == source) {
      unknown.push_back(text_of(each));
      status.add("unknown", unknown.back());
    }
  }
  if (unknown.empty()) {
    status.summary(DiagnosticStatus::OK, "all there");
  } else {
    status.summary(DiagnosticStatus::ERROR,
                   std::to_string(unknown.size()) + " unknown: " + unknown.front());
  }
  for (const auto& topic : about_.scene.environment.statistics(ros::Time::now())) {
    if (topic.topic == source) {
      add_counts(topic, status);
    }
  }
}

void Diagnostics::report_engine(Status& status) const {
  const ObservedScene& scene = about_.scene;
  const Detector& detector = about_.detector;
  const Detection& found = detector.detection();
  if (scene.fibers.inputs().empty()) {
    status.summary(DiagnosticStatus::ERROR, "no valid input in ~inputs");
  } else if (!scene.fibers.is_fresh()) {
    status.summary(DiagnosticStatus::WARN, "no fresh input");
  } else if (!scene.knowledge.is_all_known()) {
    status.summary(DiagnosticStatus::WARN, "answers are incomplete: something is unknown");
  } else {
    status.summary(DiagnosticStatus::OK, "answering");
  }
  for (const auto* unknown :
       {&scene.knowledge.unknown_fibers(), &scene.knowledge.unknown_objects()}) {
    for (const Unknown& each : *unknown) {
      status.add("unknown", text_of(each));
    }
  }
  status.add("fixed frame", scene.fibers.frame().name());
  status.add("contacts", found.contacts().contacts.size());
  if (found.minimum() != nullptr) {
    status.addf("minimum distance [m]", "%.6f", found.minimum()->distance);
  }
  status.addf("update [ms]", "%.3f", 1e3 * detector.update_time());
  status.addf("detect [ms]", "%.3f", 1e3 * detector.detect_time());
}

void Diagnostics::report_deadlines(Status& status) {
  const AnswerCounts counts = std::exchange(counts_, {});
  if (counts.cut_off == 0) {
    status.summary(DiagnosticStatus::OK, "no answer cut off");
  } else {
    status.summary(DiagnosticStatus::WARN, std::to_string(counts.cut_off) + " of " +
                                               std::to_string(counts.answers) +
                                               " answers cut off: " + counts.reason);
  }
  if (counts.hopeless > 0) {
    status.mergeSummary(DiagnosticStatus::WARN, "of " + std::to_string(counts.hopeless) +
                                                    " updates alone took longer than the deadline");
  }
  status.addf("deadline [s]", "%g", about_.query.deadline);
  status.add("pair limit", about_.query.pair_limit);
  status.add("contact limit", about_.query.contact_limit);
  status.add("answers", counts.answers);
  status.add("cut off", counts.cut_off);
  status.add("late", counts.late);
}

}  // namespace fiber_proximity_ros
