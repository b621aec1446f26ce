#pragma once

#include <ros/callback_queue.h>

#include <chrono>
#include <functional>
#include <future>
#include <memory>
#include <thread>
#include <utility>

#include "src/ros/support/callback_task.hpp"

namespace fiber_proximity_ros {

/// A thread that does jobs one after the other, in the order in which they were submitted.
class Worker {
 public:
  Worker() = default;
  /// Waits for the job that is being done; those not yet begun are dropped.
  ~Worker() {
    jobs_.disable();
    thread_.join();
  }
  Worker(const Worker&) = delete;
  Worker& operator=(const Worker&) = delete;

  /// @param job must not throw
  void submit(std::function<void()> job) { add_task(jobs_, this, std::move(job)); }

 private:
  ros::CallbackQueue jobs_;
  std::thread thread_{[this] {  // last: it uses the above
    while (jobs_.callOne(ros::WallDuration(1e6)) != ros::CallbackQueue::Disabled) {
    }
  }};
};

/// A value that is made at once, or by a worker meanwhile. The worker skips what nobody waits for
/// any more. What `make` throws, get() throws.
template <class Value>
class Prepared {
 public:
  using Make = std::function<Value()>;

  /// @param worker makes the value; without one it is made before this returns
  explicit Prepared(Make make, Worker* worker = nullptr)
      : task_(std::make_shared<Task>(std::move(make))), value_(task_->get_future()) {
    if (worker == nullptr) {
      (*task_)();
      return;
    }
    worker->submit([waiting = std::weak_ptr<Task>(task_)] {
      if (const std::shared_ptr<Task> task = waiting.lock()) {
        (*task)();
      }
    });
  }

  bool is_ready() const {
    return value_.wait_for(std::chrono::seconds(0)) == std::future_status::ready;
  }

  /// To be called once.
  Value get() { return value_.get(); }

 private:
  using Task = std::packaged_task<Value()>;

  std::shared_ptr<Task> task_;
  std::future<Value> value_;
};

}  // namespace fiber_proximity_ros
