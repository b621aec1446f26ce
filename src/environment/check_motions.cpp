#include "fiber_proximity/environment/check_motions.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <stdexcept>
#include <string>

#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/environment/path_collector.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

void check_path(const FiberPath& path, std::size_t index) {
  const std::string motion = "motion " + std::to_string(index);
  if (path.size() < 2) {
    throw std::invalid_argument(motion + " has " + std::to_string(path.size()) +
                                " states, it needs at least 2");
  }
  for (std::size_t state = 1; state < path.size(); ++state) {
    with_context(motion + ", state " + std::to_string(state),
                 [&] { require_same_topology(path.front(), path[state]); });
  }
}

/// A segment on its way, of the larger radius.
Capsule capsule_at(const FiberAssembly& before, const FiberAssembly& after, SegmentId id,
                   double time) {
  const std::uint32_t point = before.offsets()[id.fiber] + id.segment;
  const Capsule first = before.capsule(point);
  const Capsule last = after.capsule(point);
  return {(1.0 - time) * first.p0 + time * last.p0, (1.0 - time) * first.p1 + time * last.p1,
          std::max(first.radius, last.radius)};
}

/// The fibres there are, standing still; nothing if they are left out.
class StillFibers {
 public:
  explicit StillFibers(const ProximityEngine* present) {
    if (present == nullptr) {
      return;
    }
    fibers_ = present->fibers();
    if (fibers_ == nullptr) {
      throw std::logic_error("the engine of the fibres that there are has none: update it first");
    }
    engine_ = make_engine("run_tree");
    engine_->update_motion(*fibers_, *fibers_);
  }
  const ProximityEngine* engine() const { return engine_.get(); }
  const FiberAssembly& fibers() const { return *fibers_; }

 private:
  const FiberAssembly* fibers_ = nullptr;
  std::unique_ptr<ProximityEngine> engine_;
};

std::unique_ptr<ProximityEngine> make_engine_of_a_motion() {
  EngineOptions options;
  options.threads = 1;
  return make_engine("run_tree", options);
}

/// Checks one motion after the other, on one thread.
class MotionChecker {
 public:
  MotionChecker(const Surroundings& surroundings, const StillFibers& still,
                const MotionOptions& options, const Deadline& deadline)
      : surroundings_(surroundings),
        still_(still),
        options_(options),
        deadline_(deadline),
        engine_(make_engine_of_a_motion()) {}

  void check(const FiberPath& path, MotionCheck& check) {
    PathCollector self(options_, check.self);
    PathCollector fibers(options_, check.fibers);
    PathCollector environment(options_, check.environment);
    const bool is_first = options_.type == MotionType::FIRST;
    for (std::size_t step = 0; step + 1 < path.size() && !(is_first && !check.is_free()); ++step) {
      if (deadline_.has_passed()) {
        check.self.complete = check.fibers.complete = check.environment.complete = false;
        break;
      }
      ask_environment(path[step], path[step + 1], step, environment);
      ask_fibers(path[step], path[step + 1], step, fibers);
      ask_self(path[step], path[step + 1], step, self);
    }
    for (PathCollector* collector : {&self, &fibers, &environment}) {
      collector->finish();
    }
    if (is_first) {
      leave_earliest(check);
    }
  }

 private:
  MotionOptions options_for(const PathCollector& collector) const {
    MotionOptions options = collector.options();
    options.deadline = deadline_.left();
    return options;
  }

  void ask_environment(const FiberAssembly& before, const FiberAssembly& after, std::size_t step,
                       PathCollector& collector) {
    if (surroundings_.environment == nullptr || !collector.takes_step()) {
      return;
    }
    const Environment& environment = *surroundings_.environment;
    environment.query_motion(before, after, options_for(collector), surroundings_.allowed, found_);
    collector.take(found_, step, [&](const MotionContact& contact) {
      const SegmentId id{contact.fiber_a, contact.segment_a};
      const double time = std::isfinite(contact.upper) ? contact.upper : contact.lower;
      Contact where = environment.contact(capsule_at(before, after, id, time), contact.fiber_b,
                                          contact.segment_b);
      where.fiber_a = id.fiber;
      where.segment_a = id.segment;
      return where;
    });
  }

  void ask_fibers(const FiberAssembly& before, const FiberAssembly& after, std::size_t step,
                  PathCollector& collector) {
    if (still_.engine() == nullptr || !collector.takes_step()) {
      return;
    }
    still_.engine()->query_motion_shape(before, after, options_for(collector), found_);
    const FiberMotion still{still_.fibers(), still_.fibers()};
    collector.take(found_, step, [&](const MotionContact& contact) {
      return first_contact({before, after}, still, contact);
    });
  }

  void ask_self(const FiberAssembly& before, const FiberAssembly& after, std::size_t step,
                PathCollector& collector) {
    if (!surroundings_.self || !collector.takes_step()) {
      return;
    }
    engine_->update_motion(before, after);
    engine_->query_motion(options_for(collector), found_);
    const FiberMotion motion{before, after};
    collector.take(found_, step, [&](const MotionContact& contact) {
      return first_contact(motion, motion, contact);
    });
  }

  /// Of the three answers, each of which has its earliest contact.
  static void leave_earliest(MotionCheck& check) {
    PathContacts* const answers[] = {&check.self, &check.fibers, &check.environment};
    const PathContacts* earliest = nullptr;
    for (const PathContacts* answer : answers) {
      if (!answer->contacts.empty() &&
          (earliest == nullptr ||
           answer->contacts[0].when.lower < earliest->contacts[0].when.lower)) {
        earliest = answer;
      }
    }
    for (PathContacts* answer : answers) {
      if (answer != earliest) {
        answer->contacts.clear();
      }
    }
  }

  const Surroundings& surroundings_;
  const StillFibers& still_;
  const MotionOptions options_;
  const Deadline& deadline_;
  std::unique_ptr<ProximityEngine> engine_;
  MotionResult found_;
};

}  // namespace

void check_motions(const std::vector<FiberPath>& motions, const Surroundings& surroundings,
                   const MotionOptions& options, std::vector<MotionCheck>& checks) {
  validate(options);
  const Deadline deadline(options.deadline);
  for (std::size_t i = 0; i < motions.size(); ++i) {
    check_path(motions[i], i);
  }
  const StillFibers still(surroundings.fibers);
  checks.resize(motions.size());
  tbb::enumerable_thread_specific<std::unique_ptr<MotionChecker>> checkers(
      [&] { return std::make_unique<MotionChecker>(surroundings, still, options, deadline); });
  tbb::parallel_for(std::size_t{0}, motions.size(),
                    [&](std::size_t i) { checkers.local()->check(motions[i], checks[i]); });
}

}  // namespace fiber
