#include "src/ros/detection/observed_scene.hpp"

#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

ObservedScene::ObservedScene(const ros::NodeHandle& node, const ros::NodeHandle& private_node,
                             const FiberInputOptions& options, const fiber::QueryOptions& answered,
                             const std::function<void()>& on_message)
    : fibers(node, options.inputs, options.left_out, options.timing, options.fixed_frame, answered,
             on_message),
      environment(node, private_node, read_environment_options(node, private_node), fibers.frame(),
                  on_message),
      knowledge(fibers, environment) {}

ObservedScene::Changes ObservedScene::update() {
  Changes changes{};
  changes.fibers = fibers.update();
  fibers.fibers();  // merged by now, and with them their stamp
  const Stopwatch stopwatch;
  changes.environment =
      environment.update(fibers.is_fresh() ? fibers.header().stamp : ros::Time::now());
  environment_time = stopwatch.seconds();
  changes.knowledge = knowledge.update();
  return changes;
}

}  // namespace fiber_proximity_ros
