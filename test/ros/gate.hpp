#pragma once

#include <future>

#include "src/ros/support/worker.hpp"

namespace environment_test {

/// Holds a worker: none of the jobs behind it is begun until it is opened.
class Gate {
 public:
  explicit Gate(fiber_proximity_ros::Worker& worker) {
    worker.submit([opened = opened_.get_future().share()] { opened.wait(); });
  }
  ~Gate() { open(); }
  Gate(const Gate&) = delete;
  Gate& operator=(const Gate&) = delete;

  void open() {
    if (!is_open_) {
      is_open_ = true;
      opened_.set_value();
    }
  }

 private:
  bool is_open_ = false;
  std::promise<void> opened_;
};

}  // namespace environment_test
