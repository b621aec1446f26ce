#include "src/ros/outputs/diagnostics.hpp"

#include <utility>

namespace fiber_proximity_ros {

using diagnostic_msgs::DiagnosticStatus;

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
