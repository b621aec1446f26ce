#include "src/ros/environment/cloud_worker.hpp"

#include <stdexcept>
#include <utility>

#include "fiber_proximity/ros/fiber_buffer.hpp"
#include "src/ros/inputs/point_cloud_input.hpp"
#include "src/ros/support/stopwatch.hpp"

namespace fiber_proximity_ros {

CloudWorker::CloudWorker(const CloudOptions& options)
    : cells_(options), thread_([this] { run(); }) {}

CloudWorker::~CloudWorker() {
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    stops_ = true;
  }
  condition_.notify_one();
  thread_.join();
}

bool CloudWorker::submit(PlacedCloud cloud) {
  bool overtakes = false;
  {
    const std::lock_guard<std::mutex> lock(mutex_);
    overtakes = next_.has_value();
    next_ = std::move(cloud);
  }
  condition_.notify_one();
  return overtakes;
}

std::vector<CloudResult> CloudWorker::take() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return std::exchange(results_, {});
}

bool CloudWorker::is_busy() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return next_ || is_working_ || !results_.empty();
}

void CloudWorker::run() {
  std::unique_lock<std::mutex> lock(mutex_);
  for (;;) {
    condition_.wait(lock, [this] { return stops_ || next_; });
    if (stops_) {
      return;
    }
    const PlacedCloud cloud = std::move(*next_);
    next_.reset();
    is_working_ = true;
    lock.unlock();
    CloudResult result = work(cloud);
    lock.lock();
    is_working_ = false;
    results_.push_back(std::move(result));
  }
}

CloudResult CloudWorker::work(const PlacedCloud& cloud) {
  const Stopwatch stopwatch;
  CloudResult result;
  result.stamp = cloud.stamp;
  try {
    FiberBuffer chain;
    to_chains(*cloud.message, chain);
    result.counts = cells_.add(chain.points, cloud.pose, cloud.stamp.toSec());
    result.octree = cells_.octree();
  } catch (const std::exception& error) {
    result.error = error.what();
  }
  result.work_time = stopwatch.seconds();
  return result;
}

}  // namespace fiber_proximity_ros
