#include "fiber_proximity/ros/parameters.hpp"

#include <cmath>
#include <sstream>
#include <stdexcept>

namespace fiber_proximity_ros {

void refuse_parameter(const ros::NodeHandle& node, const std::string& name,
                      const std::string& allowed) {
  XmlRpc::XmlRpcValue value;
  node.getParam(name, value);
  std::ostringstream message;
  message << "parameter " << node.resolveName(name) << " is " << value << ", it must be "
          << allowed;
  throw std::invalid_argument(message.str());
}

void read_parameter(const ros::NodeHandle& node, const std::string& name, double least,
                    double& value) {
  std::ostringstream allowed;
  allowed << "a number of at least " << least;
  read_parameter(node, name, allowed.str(), value);
  if (!(value >= least && std::isfinite(value))) {
    refuse_parameter(node, name, allowed.str());
  }
}

void read_parameter(const ros::NodeHandle& node, const std::string& name, std::uint32_t& value) {
  const std::string allowed = "a whole number of at least 0";
  auto number = static_cast<int>(value);
  read_parameter(node, name, allowed, number);
  if (number < 0) {
    refuse_parameter(node, name, allowed);
  }
  value = static_cast<std::uint32_t>(number);
}

}  // namespace fiber_proximity_ros
