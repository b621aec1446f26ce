#pragma once

#include <chrono>
#include <condition_variable>
#include <deque>
#include <functional>
#include <future>
#include <memory>
#include <mutex>
#include <thread>
#include <utility>

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

/// A value that is made at once, or by a worker meanwhile. The worker skips what nobody waits for
/// any more. What `make` throws, get() throws.
template <class Value>
class Prepared {
 public:
  using Make = std::function<Value()>;

  /// Made before this returns.
  explicit Prepared(Make make) : Prepared(std::make_shared<Task>(std::move(make))) { (*task_)(); }

  /// By a worker if it takes long, else before this returns.
  static Prepared of(Make make, Worker& worker, bool takes_long) {
    return takes_long ? Prepared(std::move(make), worker) : Prepared(std::move(make));
  }

  Prepared(Make make, Worker& worker) : Prepared(std::make_shared<Task>(std::move(make))) {
    worker.submit([waiting = std::weak_ptr<Task>(task_)] {
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

  explicit Prepared(std::shared_ptr<Task> task)
      : task_(std::move(task)), value_(task_->get_future()) {}

  std::shared_ptr<Task> task_;
  std::future<Value> value_;
};

}  // namespace fiber_proximity_ros
