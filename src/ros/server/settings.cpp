#include "src/ros/server/settings.hpp"

#include <ros/console.h>

#include <stdexcept>
#include <string>

#include "src/ros/server/query_options.hpp"

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
  config_ = static_cast<const fiber_proximity::ProximityConfig&>(asked);
  query_ = to_query_options(config_);
  if (const std::string overridden = overridden_by_accuracy(config_, query_); !overridden.empty()) {
    ROS_WARN_STREAM("parameter " << private_node_.resolveName("accuracy") << " is "
                                 << config_.accuracy << ", which overrides " << overridden
                                 << "; accuracy custom uses them");
  }
}

}  // namespace fiber_proximity_ros
