#include <nodelet/nodelet.h>
#include <ros/console.h>

#include <exception>
#include <future>
#include <memory>
#include <pluginlib/class_list_macros.hpp>
#include <string>
#include <utility>

#include "src/ros/server/make_proximity_server.hpp"
#include "src/ros/sim/make_sim_server.hpp"
#include "src/ros/support/callback_task.hpp"

namespace fiber_proximity_ros {

/// A nodelet that runs a server. Why it cannot is in the log: the manager's says only that.
class ServerNodelet : public nodelet::Nodelet {
 private:
  virtual std::shared_ptr<void> make() = 0;

  /// The server is built where its callbacks come from, one at a time: the manager's threads would
  /// call others while it is half built.
  void onInit() final {
    auto build = std::make_shared<std::packaged_task<void()>>([this] { server_ = make(); });
    std::future<void> built = build->get_future();
    add_task(queue_of(getNodeHandle()), this, [build = std::move(build)] { (*build)(); });
    try {
      built.get();
    } catch (const std::exception& error) {
      ROS_FATAL_STREAM("nodelet " << getName() << ": " << error.what());
      throw;
    }
  }

  std::shared_ptr<void> server_;
};

class ProximityNodelet : public ServerNodelet {
  std::shared_ptr<void> make() override {
    return make_proximity_server(getNodeHandle(), getPrivateNodeHandle());
  }
};

class CableSimNodelet : public ServerNodelet {
  std::shared_ptr<void> make() override {
    return make_sim_server(getNodeHandle(), getPrivateNodeHandle());
  }
};

}  // namespace fiber_proximity_ros

PLUGINLIB_EXPORT_CLASS(fiber_proximity_ros::CableSimNodelet, nodelet::Nodelet)
PLUGINLIB_EXPORT_CLASS(fiber_proximity_ros::ProximityNodelet, nodelet::Nodelet)
