#include <nodelet/nodelet.h>

#include <memory>
#include <pluginlib/class_list_macros.hpp>

#include "fiber_proximity/ros/proximity_server.hpp"
#include "fiber_proximity/ros/sim_server.hpp"

namespace fiber_proximity_ros {

class ProximityNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    server_ = std::make_unique<ProximityServer>(getNodeHandle(), getPrivateNodeHandle());
  }

  std::unique_ptr<ProximityServer> server_;
};

class CableSimNodelet : public nodelet::Nodelet {
 private:
  void onInit() override {
    server_ = std::make_unique<SimServer>(getPrivateNodeHandle(),
                                          read_sim_options(getPrivateNodeHandle()));
  }

  std::unique_ptr<SimServer> server_;
};

}  // namespace fiber_proximity_ros

PLUGINLIB_EXPORT_CLASS(fiber_proximity_ros::CableSimNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fiber_proximity_ros::ProximityNodelet, nodelet::Nodelet)
