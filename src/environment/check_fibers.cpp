#include "fiber_proximity/environment/check_fibers.hpp"

#include <tbb/enumerable_thread_specific.h>
#include <tbb/parallel_for.h>

#include <limits>
#include <memory>

#include "fiber_proximity/query/options.hpp"

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
  return make_engine("run_tree", options);
}

/// Checks one candidate after the other, on one thread.
class Checker {
 public:
  Checker(const Surroundings& surroundings, const QueryOptions& options)
      : surroundings_(surroundings), options_(options), engine_(make_engine_of_one_thread()) {}

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
    return options_.type != QueryType::FIRST || check.is_free();
  }

  const Surroundings& surroundings_;
  QueryOptions options_;
  std::unique_ptr<ProximityEngine> engine_;
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

}  // namespace fiber
