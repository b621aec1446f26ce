#pragma once

#include <memory>
#include <string>

#include "fiber_proximity/query/engine.hpp"

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

  /// Finds the contacts, and the closest pair whatever the margin.
  /// @throws std::invalid_argument for options that do not validate, and as engine()
  void detect(const fiber::QueryOptions& options);

  // What the last detect() found:
  const fiber::QueryResult& contacts() const { return contacts_; }
  const fiber::Contact* minimum() const { return minimum_; }  ///< nullptr if there is no pair
  const fiber::QueryCounts& counts() const { return counts_; }

  double update_time() const { return update_time_; }  ///< [s] of the last update
  double detect_time() const { return detect_time_; }  ///< [s] of the last detection

 private:
  std::unique_ptr<fiber::ProximityEngine> engine_;
  const fiber::FiberAssembly* new_fibers_ = nullptr;
  fiber::QueryResult contacts_;
  fiber::QueryResult closest_;
  const fiber::Contact* minimum_ = nullptr;
  fiber::QueryCounts counts_;
  double update_time_ = 0.0;
  double detect_time_ = 0.0;
};

}  // namespace fiber_proximity_ros
