#pragma once

#include <condition_variable>
#include <cstdint>
#include <mutex>

namespace fiber_proximity_ros {

/// A mutex that goes to whoever has waited longest: a thread that gives it up for a moment lets all
/// that wait have their turn. For std::lock_guard and std::unique_lock.
class FairMutex {
 public:
  void lock() {
    std::unique_lock<std::mutex> lock(mutex_);
    const std::uint64_t ticket = next_ticket_++;
    turn_.wait(lock, [&] { return ticket == now_served_; });
  }

  void unlock() {
    {
      const std::lock_guard<std::mutex> lock(mutex_);
      ++now_served_;
    }
    turn_.notify_all();
  }

 private:
  std::mutex mutex_;
  std::condition_variable turn_;
  std::uint64_t next_ticket_ = 0;
  std::uint64_t now_served_ = 0;
};

}  // namespace fiber_proximity_ros
