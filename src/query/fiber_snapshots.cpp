#include "fiber_proximity/query/fiber_snapshots.hpp"

#include <utility>

namespace fiber {

FiberSnapshots::FiberSnapshots(std::string engine, const EngineOptions& options)
    : engine_(std::move(engine)), options_(options) {
  make_engine(engine_, options_);  // refuses now what could not be made later
}

void FiberSnapshots::apply(const FiberAssembly& fibers) {
  const std::shared_ptr<FiberSnapshot> next = unused();
  next->fibers = fibers;  // in the memory it has
  next->engine->update(next->fibers);
  std::shared_ptr<const FiberSnapshot> last = next;
  const std::lock_guard<std::mutex> lock(mutex_);
  newest_.swap(last);
}

std::shared_ptr<const FiberSnapshot> FiberSnapshots::newest() const {
  const std::lock_guard<std::mutex> lock(mutex_);
  return newest_;
}

std::shared_ptr<FiberSnapshot> FiberSnapshots::unused() {
  std::unique_ptr<FiberSnapshot> snapshot;
  {
    const std::lock_guard<std::mutex> lock(pool_->mutex);
    if (!pool_->unused.empty()) {
      snapshot = std::move(pool_->unused.back());
      pool_->unused.pop_back();
    }
  }
  if (snapshot == nullptr) {
    snapshot = std::make_unique<FiberSnapshot>();
    snapshot->engine = make_engine(engine_, options_);
  }
  return {snapshot.release(), [pool = pool_](FiberSnapshot* held) {
            const std::lock_guard<std::mutex> lock(pool->mutex);
            pool->unused.emplace_back(held);
          }};
}

}  // namespace fiber
