#include "src/ros/server/settings.hpp"

#include <ros/console.h>

#include <stdexcept>

#include "src/ros/server/accuracy_preset.hpp"
#include "src/ros/server/query_options.hpp"
#include "src/ros/server/server_options.hpp"

namespace fiber_proximity_ros {

Settings::Settings(const ros::NodeHandle& private_node,
                   const fiber_proximity::ProximityConfig& config)
    : private_node_(private_node), config_(config), server_(private_node) {
  server_.setCallback([this](AskedConfig& asked, std::uint32_t /*level*/) { change(asked); });
}

void Settings::change(AskedConfig& asked) {
  try {
    if (!asked.problem().empty()) {
      throw std::invalid_argument(asked.problem());
    }
    check(private_node_, asked);
  } catch (const std::invalid_argument& error) {
    ROS_ERROR_STREAM("parameters stay as they were: " << error.what());
    asked = config_;  // the server announces what is really in use
    return;
  }
  config_ = asked;
  query_ = to_query_options(config_);
  const std::string problem = accuracy_problem(config_, query_);
  if (!problem.empty() && problem != told_) {
    ROS_WARN_STREAM("parameter " << private_node_.resolveName("accuracy") << " is "
                                 << config_.accuracy << ", which " << problem);
  }
  told_ = problem;
}

}  // namespace fiber_proximity_ros
