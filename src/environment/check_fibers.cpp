#include "fiber_proximity/environment/check_fibers.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <algorithm>
#include <functional>
#include <limits>
#include <memory>
#include <set>
#include <stdexcept>
#include <string>
#include <tuple>

#include "fiber_proximity/query/motion.hpp"
#include "fiber_proximity/query/options.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "src/query/motion_evaluator.hpp"
#include "src/text/with_context.hpp"

namespace fiber {
namespace {

/// Makes it the answer to what was not asked, or was not reached before the deadline.
void forget(QueryResult& result, bool is_reached) {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  result.contacts.clear();
  result.limit_reached = false;
  result.complete = is_reached;
  result.others_lower = is_reached ? infinity : -infinity;
  result.counts = QueryCounts();
}

std::unique_ptr<ProximityEngine> make_engine_of_one_thread() {
  EngineOptions options;
  options.threads = 1;
  options.skin = 0.0;  // a candidate is no frame that follows on another
  return make_engine("run_tree", options);
}

/// Checks one candidate after the other, on one thread.
class Checker {
 public:
  Checker(const Surroundings& surroundings, const QueryOptions& options)
      : surroundings_(surroundings),
        options_(options),
        depends_on_order_(options.type == QueryType::FIRST || options.pair_limit > 0 ||
                          options.tolerance > 0.0 || options.relative_tolerance > 0.0),
        engine_(make_engine_of_one_thread()) {}

  void check(const FiberAssembly& candidate, const Deadline& deadline, FiberCheck& check) {
    const bool is_reached = !deadline.has_passed();
    forget(check.self, is_reached);
    forget(check.fibers, is_reached);
    forget(check.environment, is_reached);
    if (!is_reached) {
      return;
    }
    if (surroundings_.environment != nullptr) {
      surroundings_.environment->query(candidate, options(deadline), surroundings_.allowed,
                                       check.environment);
    }
    if (surroundings_.fibers != nullptr && is_to_go_on(check)) {
      surroundings_.fibers->query_shape(candidate, options(deadline), check.fibers);
    }
    if (surroundings_.self && is_to_go_on(check)) {
      if (depends_on_order_) {
        engine_->update(none_);  // what it knows of another candidate would decide what it finds
      }
      engine_->update(candidate);
      engine_->query(options(deadline), check.self);
    }
  }

 private:
  const QueryOptions& options(const Deadline& deadline) {
    options_.deadline = deadline.left();
    return options_;
  }
  bool is_to_go_on(const FiberCheck& check) const {
    return options_.type != QueryType::FIRST || !check.has_contact();
  }

  const Surroundings& surroundings_;
  QueryOptions options_;
  const bool depends_on_order_;  // whether the answer does, of the pairs that the engine looks at
  const FiberAssembly none_;
  std::unique_ptr<ProximityEngine> engine_;
};

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

/// Puts together what the steps of a path find: of each pair the first contact, of these the
/// earliest ones.
class PathCollector {
 public:
  /// Reports a contact in a step.
  using Report = std::function<Contact(const MotionContact&)>;

  /// @param contacts is cleared
  PathCollector(const MotionOptions& options, PathContacts& contacts)
      : options_(options), max_(max_reported(options)), contacts_(contacts) {
    contacts_.contacts.clear();
    contacts_.limit_reached = false;
    contacts_.complete = true;
  }

  /// Whether the next step is to be asked: not if there are as many contacts as may be, of earlier
  /// ones.
  bool takes_step() {
    has_left_out_ = has_left_out_ || (max_ > 0 && contacts_.contacts.size() >= max_);
    return !has_left_out_;
  }

  /// The options of the next step.
  MotionOptions options() const {
    MotionOptions options = options_;
    options.type = MotionType::ALL;
    // Some of what a step finds are pairs that met before: so many more are needed.
    constexpr std::size_t largest = std::numeric_limits<std::uint32_t>::max();
    options.contact_limit =
        static_cast<std::uint32_t>(max_ == 0 ? 0 : std::min(max_ + seen_.size(), largest));
    return options;
  }

  /// Takes what a step, the one from this state on, has found.
  void take(const MotionResult& found, std::size_t step, const Report& report) {
    const auto begin = static_cast<double>(step);
    for (const auto* list : {&found.touching, &found.contacts}) {
      for (const MotionContact& contact : *list) {
        if (seen_.insert(contact.key()).second) {
          contacts_.contacts.push_back({contact, report(contact)});
          contacts_.contacts.back().when.lower += begin;
          contacts_.contacts.back().when.upper += begin;
        }
      }
    }
    contacts_.complete = contacts_.complete && found.complete;
    const bool is_cut_short = found.limit_reached && !found.complete;  // not for too many contacts
    contacts_.limit_reached = contacts_.limit_reached || is_cut_short ||
                              (found.limit_reached && options_.type != MotionType::FIRST);
  }

  void finish() {
    std::vector<PathContact>& contacts = contacts_.contacts;
    const bool are_more = has_left_out_ || (max_ > 0 && contacts.size() > max_);
    contacts_.limit_reached =
        contacts_.limit_reached || (are_more && options_.type != MotionType::FIRST);
    if (max_ > 0 && contacts.size() > max_) {
      std::sort(contacts.begin(), contacts.end(), [](const PathContact& x, const PathContact& y) {
        return x.when.earlier_than(y.when);
      });
      contacts.resize(max_);
    }
    std::sort(contacts.begin(), contacts.end(), [](const PathContact& x, const PathContact& y) {
      return x.when.key() < y.when.key();
    });
  }

 private:
  using Key = std::tuple<std::uint32_t, std::uint32_t, std::uint32_t, std::uint32_t>;

  const MotionOptions options_;
  std::size_t max_;  // to be reported, 0 for no limit
  PathContacts& contacts_;
  std::set<Key> seen_;
  bool has_left_out_ = false;
};

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

/// Checks one motion after the other, on one thread.
class MotionChecker {
 public:
  MotionChecker(const Surroundings& surroundings, const StillFibers& still,
                const MotionOptions& options, const Deadline& deadline)
      : surroundings_(surroundings),
        still_(still),
        options_(options),
        deadline_(deadline),
        engine_(make_engine_of_one_thread()) {}

  void check(const FiberPath& path, MotionCheck& check) {
    PathCollector self(options_, check.self);
    PathCollector fibers(options_, check.fibers);
    PathCollector environment(options_, check.environment);
    const bool is_first = options_.type == MotionType::FIRST;
    for (std::size_t step = 0; step + 1 < path.size() && !(is_first && check.has_contact());
         ++step) {
      if (deadline_.has_passed()) {
        check.self.complete = check.fibers.complete = check.environment.complete = false;
        break;
      }
      const FiberMotion motion{path[step], path[step + 1]};
      ask_environment(motion, step, environment);
      ask_fibers(motion, step, fibers);
      ask_self(motion, step, self);
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

  void ask_environment(const FiberMotion& motion, std::size_t step, PathCollector& collector) {
    if (surroundings_.environment == nullptr || !collector.takes_step()) {
      return;
    }
    const Environment& environment = *surroundings_.environment;
    environment.query_motion(motion.before, motion.after, environment, options_for(collector),
                             surroundings_.allowed, found_);
    collector.take(found_, step, [&](const MotionContact& contact) {
      return environment.first_contact(motion, environment, contact);
    });
  }

  void ask_fibers(const FiberMotion& motion, std::size_t step, PathCollector& collector) {
    if (still_.engine() == nullptr || !collector.takes_step()) {
      return;
    }
    still_.engine()->query_motion_shape(motion.before, motion.after, options_for(collector),
                                        found_);
    const FiberMotion still{still_.fibers(), still_.fibers()};
    collector.take(found_, step, [&](const MotionContact& contact) {
      return first_contact(motion, still, contact);
    });
  }

  void ask_self(const FiberMotion& motion, std::size_t step, PathCollector& collector) {
    if (!surroundings_.self || !collector.takes_step()) {
      return;
    }
    engine_->update_motion(motion.before, motion.after);
    engine_->query_motion(options_for(collector), found_);
    collector.take(found_, step, [&](const MotionContact& contact) {
      return first_contact(motion, motion, contact);
    });
  }

  /// Keeps the earliest of the three answers, each of which has its own.
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

void check_fibers(const std::vector<FiberAssembly>& candidates, const Surroundings& surroundings,
                  const QueryOptions& options, std::vector<FiberCheck>& checks) {
  validate(options);
  const Deadline deadline(options.deadline);
  checks.resize(candidates.size());
  tbb::enumerable_thread_specific<Checker> checkers(surroundings, options);
  tbb::parallel_for(std::size_t{0}, candidates.size(), [&](std::size_t i) {
    checkers.local().check(candidates[i], deadline, checks[i]);
  });
}

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
