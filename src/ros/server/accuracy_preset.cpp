#include "src/ros/server/accuracy_preset.hpp"

#include <sstream>
#include <stdexcept>
#include <vector>

#include "src/text/join.hpp"
#include "src/text/quote.hpp"

namespace fiber_proximity_ros {
namespace {

/// Whether it is the accuracy that a deadline allows, and there is none.
bool waits_for_deadline(const std::string& accuracy, double deadline) {
  return accuracy == "deadline" && deadline == 0.0;
}

}  // namespace

void apply_accuracy(const std::string& accuracy, fiber::QueryOptions& options) {
  if (accuracy == "custom" || waits_for_deadline(accuracy, options.deadline)) {
    return;
  }
  options.tolerance = 0.0;
  options.relative_tolerance = 0.0;
  if (accuracy == "deadline") {
    options.kernel = fiber::Kernel::ROBUST;
    return;
  }
  options.deadline = 0.0;
  try {
    options.kernel = fiber::kernel_from_name(accuracy);
  } catch (const std::invalid_argument&) {
    throw std::invalid_argument("unknown accuracy " + fiber::quote(accuracy) +
                                ", known are: custom, robust, exact, deadline");
  }
}

std::string accuracy_problem(const AskedConfig& config, const fiber::QueryOptions& options) {
  if (waits_for_deadline(config.accuracy, config.deadline)) {
    return "has no effect until deadline is above 0 s";
  }
  std::vector<std::string> overridden;
  const auto& defaults = fiber_proximity::ProximityConfig::__getDefault__();
  if (config.kernel != name_of(options.kernel) &&
      (config.kernel != defaults.kernel || config.has_named("kernel"))) {
    overridden.push_back("kernel " + config.kernel);
  }
  const auto add = [&overridden](const std::string& name, double value, double used) {
    if (value != used) {
      std::ostringstream text;
      text << name << ' ' << value;
      overridden.push_back(text.str());
    }
  };
  add("tolerance", config.tolerance, options.tolerance);
  add("relative_tolerance", config.relative_tolerance, options.relative_tolerance);
  add("deadline", config.deadline, options.deadline);
  if (overridden.empty()) {
    return "";
  }
  return "overrides " + fiber::join(overridden) + "; accuracy custom uses them";
}

}  // namespace fiber_proximity_ros
