#pragma once

#include <memory>
#include <mutex>
#include <utility>
#include <vector>

namespace fiber {

/// Memory of queries, kept from one to the next. Queries that run at the same time do not share:
/// there come to be as many as do.
template <class Memory>
class IdleMemory {
 public:
  template <class Call>
  void lend(const Call& call) {
    std::unique_ptr<Memory> memory;
    {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        memory = std::move(idle_.back());
        idle_.pop_back();
      }
    }
    if (memory == nullptr) {
      memory = std::make_unique<Memory>();
    }
    call(*memory);
    const std::lock_guard lock(mutex_);
    idle_.push_back(std::move(memory));
  }

 private:
  std::mutex mutex_;
  std::vector<std::unique_ptr<Memory>> idle_;
};

}  // namespace fiber
