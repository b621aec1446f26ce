#include "src/ros/environment/obstacle_service.hpp"

#include <future>
#include <utility>

#include "src/ros/support/callback_task.hpp"

namespace fiber_proximity_ros {
namespace {

/// Requests that may wait at the same time, as those of different clients do for large meshes.
constexpr std::uint32_t waiting_request_count = 4;

}  // namespace

ObstacleService::ObstacleService(const ros::NodeHandle& private_node, Apply apply)
    : apply_(std::move(apply)),
      queue_(queue_of(private_node)),
      spinner_(waiting_request_count, &own_queue_) {
  ros::NodeHandle node(private_node);
  node.setCallbackQueue(&own_queue_);
  server_ = node.advertiseService("apply_obstacles", &ObstacleService::answer, this);
  spinner_.start();
}

ObstacleService::~ObstacleService() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stops_ = true;
  }
  remove_tasks(queue_, this);
  spinner_.stop();
  server_.shutdown();
}

bool ObstacleService::answer(fiber_proximity::ApplyObstacles::Request& request,
                             fiber_proximity::ApplyObstacles::Response& response) {
  auto promise = std::make_shared<std::promise<std::string>>();
  std::future<std::string> reason = promise->get_future();
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    if (!stops_) {
      auto obstacles = std::make_shared<const std::vector<fiber_proximity::Obstacle>>(
          std::move(request.obstacles));
      add_task(queue_, this, [this, obstacles, promise = std::move(promise)] {
        apply_(obstacles, [promise](const std::string& why) { promise->set_value(why); });
      });
    }
  }
  promise.reset();  // the task's is the last: once that is gone nobody will answer
  try {
    response.message = reason.get();
    response.success = response.message.empty();
  } catch (const std::future_error&) {
    response.message = "the node ends";
  }
  return true;
}

}  // namespace fiber_proximity_ros
