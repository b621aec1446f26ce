#pragma once

#include <memory>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "src/ros/outputs/detection.hpp"

namespace fiber_proximity_ros {

/// Contacts and closest pair of the newest fibres, from one engine whose update waits until it is
/// asked something.
class Detector {
 public:
  /// @throws std::invalid_argument for an unknown engine, or for options that are not allowed
  explicit Detector(const std::string& engine, const fiber::EngineOptions& options = {})
      : engine_(fiber::make_engine(engine, options)) {}

  /// The fibres to ask about from now on; they must live, unchanged, until the next call.
  void set_fibers(const fiber::FiberAssembly& fibers);

  /// The engine, updated to the fibres.
  /// @throws std::invalid_argument for fibres the engine cannot take (AL-threaded: unequal ones)
  const fiber::ProximityEngine& engine();

  /// Finds the contacts and, if it is wanted, the closest pair whatever the margin.
  /// @throws std::invalid_argument for options that do not validate, and as engine()
  void detect(const fiber::QueryOptions& options, bool wants_minimum = true);

  /// What the last detect() found.
  const Detection& detection() const { return detection_; }

  double update_time() const { return update_time_; }  ///< [s] of the last update
  double detect_time() const {                         ///< [s] of the last detection
    return detection_.contact_time() + detection_.minimum_time();
  }

 private:
  std::unique_ptr<fiber::ProximityEngine> engine_;
  const fiber::FiberAssembly* new_fibers_ = nullptr;
  Detection detection_;
  double update_time_ = 0.0;
};

}  // namespace fiber_proximity_ros
