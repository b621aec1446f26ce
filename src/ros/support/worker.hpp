#pragma once

#include <condition_variable>
#include <deque>
#include <functional>
#include <mutex>
#include <thread>

namespace fiber_proximity_ros {

/// A thread that does jobs one after the other, in the order in which they were submitted.
class Worker {
 public:
  Worker();
  /// Waits for the job that is being done; those not yet begun are dropped.
  ~Worker();
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// @param job must not throw
  void submit(std::function<void()> job);

 private:
  void run();

  std::mutex mutex_;
  std::condition_variable condition_;
  std::deque<std::function<void()>> jobs_;
  bool stops_ = false;

  std::thread thread_;  // last: it uses all of the above
};

}  // namespace fiber_proximity_ros
