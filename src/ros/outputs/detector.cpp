#include "src/ros/outputs/detector.hpp"

#include "src/ros/support/stopwatch.hpp"

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

void Detector::detect(const fiber::QueryOptions& options, bool wants_minimum) {
  const fiber::ProximityEngine& updated = engine();
  detection_.detect(options, wants_minimum,
                    [&](const fiber::QueryOptions& asked, fiber::QueryResult& result) {
                      updated.query(asked, result);
                    });
}

}  // namespace fiber_proximity_ros
