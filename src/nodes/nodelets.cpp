#include <nodelet/nodelet.h>
#include <ros/console.h>

#include <exception>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>

#include "src/ros/server/proximity_server.hpp"
#include "src/ros/sim/sim_server.hpp"

namespace fiber_proximity_ros {
namespace {

/// Makes what a nodelet runs; why it cannot is in the manager's log, which says only that.
template <class Make>
auto make_or_log(const std::string& name, const Make& make) {
  try {
    return make();
  } catch (const std::exception& error) {
    ROS_FATAL_STREAM("nodelet " << name << ": " << error.what());
    throw;
  }
}

}  // namespace

class ProximityNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    server_ = make_or_log(getName(), [this] {
      return std::make_unique<ProximityServer>(getNodeHandle(), getPrivateNodeHandle());
    });
  }

  std::unique_ptr<ProximityServer> server_;
};

class CableSimNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    server_ = make_or_log(getName(), [this] {
      return std::make_unique<SimServer>(getPrivateNodeHandle(),
                                         read_sim_options(getPrivateNodeHandle()));
    });
  }

  std::unique_ptr<SimServer> server_;
};

}  // namespace fiber_proximity_ros

PLUGINLIB_EXPORT_CLASS(fiber_proximity_ros::CableSimNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fiber_proximity_ros::ProximityNodelet, nodelet::Nodelet)
