#pragma once

#include <memory>
#include <shared_mutex>
#include <string>

#include "fiber_proximity/query/engine.hpp"
#include "src/python/contacts.hpp"
#include "src/python/fibers.hpp"
#include "src/query/idle_memory.hpp"

namespace fiber::python {

/// An engine that any number of Python's threads may use: queries run at the same time, an update
/// waits for them. It keeps the fibres of its last update alive, as they were then.
class Engine : public OnlyShared {
 public:
  Engine(std::string name, std::int64_t threads, std::optional<double> skin);

  /// Asks about these fibres, as they are now, from now on.
  /// @param fibers null for those of the last update
  void update(std::shared_ptr<Fibers> fibers);

  /// Calls with the result, which it may empty, of a query about the engine's fibres, or about them
  /// and a shape.
  /// @param shape null for none
  template <class Use>
  void query(const QueryOptions& options, const Fibers::State& shape, const Use& use) {
    results_.lend([&](QueryResult& result) {
      {
        const WithoutPythonLock others_may_run;
        read([&](const ProximityEngine& engine) {
          shape == nullptr ? engine.query(options, result)
                           : engine.query_shape(*shape, options, result);
        });
      }
      use(result);
    });
  }

  /// When pairs come into contact, by an engine of its own.
  std::shared_ptr<MotionAnswer> motion(const Fibers::State& before, const Fibers::State& after,
                                       const MotionOptions& options);

  /// @param points (3,) or (m, 3) [m]
  py::array nearest(const py::object& points, std::int64_t k);

  /// Calls with the engine, which is not updated meanwhile. Without Python's lock.
  template <class Call>
  void read(const Call& call) const {
    const std::shared_lock<std::shared_mutex> lock(mutex_);
    call(*engine_);
  }

  const std::string& name() const { return name_; }

  /// Those of the last update, null before the first one.
  std::shared_ptr<Fibers> fibers() const;

 private:
  const std::string name_;
  EngineOptions options_;

  mutable std::shared_mutex mutex_;  // guards what follows
  std::shared_ptr<Fibers> fibers_;
  Fibers::State state_;  // that the engine refers to
  std::unique_ptr<ProximityEngine> engine_;
  IdleMemory<QueryResult> results_;

  std::mutex motion_mutex_;  // of an engine of its own, as a motion takes the fibres' place
  std::unique_ptr<ProximityEngine> motion_engine_;
};

}  // namespace fiber::python
