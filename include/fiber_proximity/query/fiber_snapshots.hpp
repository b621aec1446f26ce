#pragma once

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// Fibres of one moment and an engine that is updated to them; nothing of it changes while somebody
/// holds it.
struct FiberSnapshot {
  FiberAssembly fibers;
  std::unique_ptr<ProximityEngine> engine;
};

/// Lets any number of threads ask about the newest fibres while one thread applies the next ones.
/// Snapshots that nobody holds any more are used again: with readers that are quick there are two
/// of them, and their memory stays.
class FiberSnapshots {
 public:
  /// @throws std::invalid_argument as make_engine()
  explicit FiberSnapshots(std::string engine = "run_tree", const EngineOptions& options = {});

  /// Makes these the newest fibres. From one thread at a time.
  /// @throws std::invalid_argument for fibres the engine cannot take; the newest stay then
  void apply(const FiberAssembly& fibers);

  /// The newest fibres, nullptr before the first ones.
  std::shared_ptr<const FiberSnapshot> newest() const;

 private:
  /// Where a snapshot goes when the last one who holds it lets go.
  struct Pool {
    std::mutex mutex;
    std::vector<std::unique_ptr<FiberSnapshot>> unused;
  };

  std::shared_ptr<FiberSnapshot> unused();

  std::string engine_;
  EngineOptions options_;
  std::shared_ptr<Pool> pool_ = std::make_shared<Pool>();  // may outlive this object
  mutable std::mutex mutex_;
  std::shared_ptr<const FiberSnapshot> newest_;
};

}  // namespace fiber
