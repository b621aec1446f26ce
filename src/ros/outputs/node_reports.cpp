#include "src/ros/outputs/node_reports.hpp"

#include <limits>
#include <utility>

namespace fiber_proximity_ros {
namespace {

using diagnostic_msgs::DiagnosticStatus;

std::uint32_t to_count(std::size_t count) { return static_cast<std::uint32_t>(count); }

}  // namespace

StatisticsOutput::StatisticsOutput(ros::NodeHandle& private_node, const Subject& about)
    : about_(about),
      publisher_(private_node.advertise<fiber_proximity::Statistics>("statistics", 1)) {}

void StatisticsOutput::add_part(const std::string& name, double seconds) {
  parts_.emplace_back(name, seconds);
}

void StatisticsOutput::publish(fiber::Kernel kernel, double time) {
  fiber_proximity::Statistics& message = message_;
  message.header = about_.inputs.header();
  message.engine = about_.engine;
  message.fibers = to_count(about_.inputs.fibers().fiber_count());
  message.points = to_count(about_.inputs.fibers().point_count());
  message.segments = to_count(about_.inputs.fibers().segment_count());
  const Detection& found = about_.detector.detection();
  message.contacts = to_count(found.contacts().contacts.size());
  message.minimum_distance = found.minimum() != nullptr ? found.minimum()->distance
                                                        : std::numeric_limits<double>::infinity();
  message.merge_time = parts_.front().second;
  message.update_time = about_.detector.update_time();
  message.detect_time = about_.detector.detect_time();
  message.total_time = parts_.front().second + time;
  message.kernel = name_of(kernel);
  message.complete = found.is_complete();
  message.limit_reached = found.is_limit_reached();
  message.minimum_lower = found.minimum_lower();
  message.minimum_upper = found.minimum_upper();
  message.contact_error = found.contact_error();
  message.node_tests = found.counts().node_tests;
  message.node_overlaps = found.counts().node_overlaps;
  message.primitive_tests = found.counts().primitive_tests;
  message.parts.clear();
  message.part_times.clear();
  for (const auto& [name, seconds] : parts_) {
    message.parts.push_back(name);
    message.part_times.push_back(seconds);
  }
  message.discrete_answers = about_.step.problem_count();
  message.discrete_reason = about_.step.problem();
  const bool is_alone = !about_.environment.is_used();
  message.objects = is_alone ? 0 : to_count(about_.environment.environment().objects().size());
  message.environment_contacts =
      is_alone ? 0 : to_count(about_.environment.detection().contacts().contacts.size());
  message.unknown_objects = about_.environment.inputs().unknown();
  message.inputs.clear();
  for (const std::unique_ptr<Input>& input : about_.inputs.inputs()) {
    message.inputs.push_back(input->statistics(ros::Time::now()));
  }
  for (const auto& input : about_.environment.inputs().statistics(ros::Time::now())) {
    message.inputs.push_back(input);
  }
  publisher_.publish(message);
}

Diagnostics::Diagnostics(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                         const InputSet& inputs, const Detector& detector)
    : inputs_(inputs),
      detector_(detector),
      seen_(inputs.inputs().size()),
      updater_(node, private_node, private_node.getNamespace()) {
  updater_.setHardwareID("none");
  for (std::size_t i = 0; i < seen_.size(); ++i) {
    updater_.add("input " + inputs.inputs()[i]->options().topic,
                 [this, i](Status& status) { report_input(i, status); });
  }
  updater_.add("engine", [this](Status& status) { report_engine(status); });
}

void Diagnostics::report_input(std::size_t index, Status& status) {
  const fiber_proximity::InputStatistics input =
      inputs_.inputs()[index]->statistics(ros::Time::now());
  Seen now;
  now.received = input.received;
  now.refused = input.refused;
  const Seen before = std::exchange(seen_[index], now);
  const double seconds = (now.time - before.time).toSec();

  if (input.stale) {
    status.summary(DiagnosticStatus::ERROR, "stale: " + inputs_.inputs()[index]->stale_reason());
  } else if (now.refused > before.refused) {
    status.summary(DiagnosticStatus::ERROR, "messages refused: " + input.last_error);
  } else if (input.age < 0.0) {
    status.summary(DiagnosticStatus::WARN, "no message yet");
  } else {
    status.summary(DiagnosticStatus::OK, "receiving");
  }
  status.add("type", input.type);
  status.add("fibres", input.fibers);
  status.addf("rate [Hz]", "%.1f", static_cast<double>(now.received - before.received) / seconds);
  status.addf("age [s]", "%.3f", input.age);
  status.add("received", input.received);
  status.add("refused", input.refused);
  status.add("overtaken", input.overtaken);
  status.add("dropped", input.dropped < 0 ? "unknown" : std::to_string(input.dropped));
  status.add("missing points", input.missing_points);
  status.add("missing fibres", input.missing_fibers);
  status.add("lone points", input.lone_points);
  status.add("last error", input.last_error);
}

void Diagnostics::report_engine(Status& status) {
  if (inputs_.inputs().empty()) {
    status.summary(DiagnosticStatus::ERROR, "no valid input in ~inputs");
  } else if (!inputs_.is_fresh()) {
    status.summary(DiagnosticStatus::WARN, "no fresh input");
  } else {
    status.summary(DiagnosticStatus::OK, "answering");
  }
  status.add("fixed frame", inputs_.frame().name());
  const Detection& found = detector_.detection();
  status.add("contacts", found.contacts().contacts.size());
  if (found.minimum() != nullptr) {
    status.addf("minimum distance [m]", "%.6f", found.minimum()->distance);
  }
  status.addf("update [ms]", "%.3f", 1e3 * detector_.update_time());
  status.addf("detect [ms]", "%.3f", 1e3 * detector_.detect_time());
}

}  // namespace fiber_proximity_ros
