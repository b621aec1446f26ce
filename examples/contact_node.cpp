// A ROS node that asks the library itself: it takes a FiberArray and logs the closest pair of
// fibres. The proximity node does the same over topics; this is for who wants contacts inside
// another node.
#include <fiber_proximity/FiberArray.h>
#include <ros/ros.h>

#include <fiber_proximity/query/engine.hpp>
#include <fiber_proximity/ros/conversions.hpp>
#include <limits>
#include <memory>
#include <stdexcept>

class ContactNode {
 public:
  ContactNode() : subscriber_(node_.subscribe("fibers", 1, &ContactNode::receive, this)) {
    options_.type = fiber::QueryType::CLOSEST;
    options_.margin = std::numeric_limits<double>::infinity();
  }

 private:
  void receive(const fiber_proximity::FiberArray& message) {
    try {
      fiber_proximity_ros::FiberBuffer chains;
      fiber_proximity_ros::to_chains(message, chains);
      assign(chains, fibers_);
    } catch (const std::invalid_argument& error) {
      ROS_WARN_STREAM("left out: " << error.what());
      return;
    }
    engine_->update(fibers_);
    engine_->query(options_, result_);
    if (const fiber::Contact* const closest = result_.closest()) {
      ROS_INFO_STREAM("fibres " << closest->fiber_a << " and " << closest->fiber_b << " are "
                                << closest->distance << " m apart");
    }
  }

  ros::NodeHandle node_;
  ros::Subscriber subscriber_;
  std::unique_ptr<fiber::ProximityEngine> engine_ = fiber::make_engine("run_tree");
  fiber::FiberAssembly fibers_;
  fiber::QueryOptions options_;
  fiber::QueryResult result_;
};

int main(int argc, char** argv) {
  ros::init(argc, argv, "contact_node");
  const ContactNode contact_node;
  ros::spin();
}
