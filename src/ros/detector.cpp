#include "fiber_proximity/ros/detector.hpp"

#include <limits>

#include "fiber_proximity/ros/stopwatch.hpp"

namespace fiber_proximity_ros {

void Detector::set_fibers(const fiber::FiberAssembly& fibers) { new_fibers_ = &fibers; }

const fiber::ProximityEngine& Detector::engine() {
  if (new_fibers_ != nullptr) {
    const Stopwatch stopwatch;
    engine_->update(*new_fibers_);
    new_fibers_ = nullptr;  // only now: fibres the engine refuses are refused whenever it is asked
    update_time_ = stopwatch.seconds();
  }
  return *engine_;
}

void Detector::detect(const fiber::QueryOptions& options) {
  const fiber::ProximityEngine& updated = engine();
  const Stopwatch stopwatch;
  updated.query(options, contacts_);
  counts_ = contacts_.counts;
  // The first contact found need not be the closest.
  minimum_ = options.type == fiber::QueryType::FIRST ? nullptr : contacts_.closest();
  if (minimum_ == nullptr) {
    fiber::QueryOptions closest = options;
    closest.type = fiber::QueryType::CLOSEST;
    closest.margin = std::numeric_limits<double>::infinity();
    updated.query(closest, closest_);
    minimum_ = closest_.closest();
    counts_.node_tests += closest_.counts.node_tests;
    counts_.node_overlaps += closest_.counts.node_overlaps;
    counts_.primitive_tests += closest_.counts.primitive_tests;
  }
  detect_time_ = stopwatch.seconds();
}

}  // namespace fiber_proximity_ros
