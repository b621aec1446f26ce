#include "fiber_proximity/query/engine.hpp"

#include <tbb/task_arena.h>

#include <algorithm>
#include <limits>
#include <stdexcept>

#include "src/geometry/fiber_graph.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "src/query/contact_evaluator.hpp"
#include "src/query/idle_memory.hpp"
#include "src/query/motion_evaluator.hpp"

namespace fiber {
namespace {

// Contacts are left to those that write them: clearing them would have them all initialized anew.
void reset(QueryResult& result) {
  result.limit_reached = false;
  result.complete = true;
  result.counts = {};
}

void reset(MotionResult& result) {
  result.contacts.clear();
  result.touching.clear();
}

void reset(MotionCandidates& candidates) {
  candidates.keys.clear();
  candidates.are_all = true;
  candidates.are_too_many = false;
  candidates.counts = {};
}

/// For pairs that may be reported: those that come within the margin and the tolerance.
QueryOptions candidates_of(const MotionOptions& options) {
  QueryOptions pairs = pairs_of(options);
  pairs.margin = (1.0 + 0x1p-50) * (options.margin + options.tolerance);
  return pairs;
}

/// For an engine that finds candidates as contacts.
QueryOptions candidate_options(const NarrowPhase& test, const QueryLimits& limits) {
  QueryOptions options;
  options.margin = test.margin();
  options.kernel = Kernel::EXACT;  // decides without any error
  options.deadline = limits.deadline.left();
  options.pair_limit = limits.pairs == std::numeric_limits<std::uint64_t>::max() ? 0 : limits.pairs;
  return options;
}

/// Makes candidates of contacts of swept segments.
void take(const QueryResult& result, const FiberAssembly& a, const FiberAssembly& b,
          const NarrowPhase& test, const QueryLimits& limits, MotionCandidates& candidates) {
  for (const Contact& contact : result.contacts) {
    const PointPair pair = test.ordered({a.offsets()[contact.fiber_a] + contact.segment_a,
                                         b.offsets()[contact.fiber_b] + contact.segment_b});
    if (!test.is_left_out(pair)) {
      candidates.keys.push_back(pair_key(pair));
    }
  }
  std::sort(candidates.keys.begin(), candidates.keys.end());
  candidates.are_all = result.complete || result.limit_reached;
  candidates.are_too_many = result.limit_reached || candidates.keys.size() > limits.pairs;
  if (candidates.are_too_many) {
    candidates.keys.clear();
  }
  candidates.counts = result.counts;
}

const FiberAssembly& require_fibers(const FiberAssembly* fibers) {
  if (fibers == nullptr) {
    throw std::logic_error("the engine has no fibres yet: call update() first");
  }
  return *fibers;
}

}  // namespace

/// The states that a motion is between, what is swept where the engine needs that, and what queries
/// about it work in; all memory is kept.
struct ProximityEngine::Motion {
  struct Memory {
    MotionCandidates candidates;
    MotionEvaluator evaluator;
  };

  const FiberAssembly* before = nullptr;
  const FiberAssembly* after = nullptr;
  SweptFibers swept;
  mutable IdleMemory<Memory> memory;
};

ProximityEngine::ProximityEngine() = default;
ProximityEngine::~ProximityEngine() = default;

/// Calls update(same_topology) for these fibres. One that throws leaves no half-updated engine
/// behind.
template <class Update>
void ProximityEngine::update_from(const FiberAssembly& fibers, const Update& update) {
  // Candidates that are kept depend on what is joined, too.
  const bool same_topology = has_hierarchy_ && offsets_ == fibers.offsets() &&
                             join_alike(graph_.get(), fibers.graph().get());
  fibers_ = nullptr;
  has_hierarchy_ = false;
  if (motion_ != nullptr) {
    motion_->before = nullptr;
  }
  update(same_topology);
  if (!same_topology) {
    offsets_ = fibers.offsets();
    graph_ = fibers.graph();
  }
  has_hierarchy_ = true;
}

void ProximityEngine::update(const FiberAssembly& fibers) {
  update_from(fibers, [&](bool same_topology) { do_update(fibers, same_topology); });
  fibers_ = &fibers;
}

void ProximityEngine::update_motion(const FiberAssembly& before, const FiberAssembly& after) {
  update_from(before, [&](bool same_topology) {
    if (motion_ == nullptr) {
      motion_ = std::make_unique<Motion>();
    }
    do_update_motion(before, after, same_topology);
  });
  motion_->before = &before;
  motion_->after = &after;
}

void ProximityEngine::query(const QueryOptions& options, QueryResult& result) const {
  validate(options);
  reset(result);
  do_query(require_fibers(fibers_), options, result);
}

void ProximityEngine::query_shape(const FiberAssembly& shape, const QueryOptions& options,
                                  QueryResult& result) const {
  validate(options);
  reset(result);
  do_query_shape(shape, require_fibers(fibers_), options, result);
}

void ProximityEngine::query_motion(const MotionOptions& options, MotionResult& result) const {
  find_motions(nullptr, options, result);
}

void ProximityEngine::query_motion_shape(const FiberAssembly& shape_before,
                                         const FiberAssembly& shape_after,
                                         const MotionOptions& options, MotionResult& result) const {
  const FiberMotion shape{shape_before, shape_after};
  find_motions(&shape, options, result);
}

/// @param shape null: of the fibres with each other
void ProximityEngine::find_motions(const FiberMotion* shape, const MotionOptions& options,
                                   MotionResult& result) const {
  validate(options);
  reset(result);
  if (motion_ == nullptr || motion_->before == nullptr) {
    throw std::logic_error("the engine has no motion: call update_motion() first");
  }
  const FiberMotion fibers{*motion_->before, *motion_->after};
  const QueryOptions pairs = candidates_of(options);
  const auto work = [&] {
    const QueryLimits limits(pairs);
    const NarrowPhase test = shape != nullptr ? NarrowPhase(shape->before, fibers.before, pairs)
                                              : NarrowPhase(fibers.before, pairs, loops_before());
    motion_->memory.lend([&](Motion::Memory& memory) {
      reset(memory.candidates);
      do_find_candidates(shape, test, limits, memory.candidates);
      memory.evaluator.evaluate(memory.candidates, shape != nullptr ? *shape : fibers, fibers, test,
                                options, limits, result);
    });
  };
  on_threads(std::cref(work));  // a function of its own would be allocated
}

void ProximityEngine::do_update_motion(const FiberAssembly& before, const FiberAssembly& after,
                                       bool same_topology) {
  motion_->swept.update(before, after);
  do_update(motion_->swept.fibers(), same_topology);
}

void ProximityEngine::do_find_candidates(const FiberMotion* shape, const NarrowPhase& test,
                                         const QueryLimits& limits,
                                         MotionCandidates& candidates) const {
  const FiberAssembly& swept = motion_->swept.fibers();
  QueryOptions options = candidate_options(test, limits);
  QueryResult result;
  if (shape == nullptr) {
    // Rules that depend on where the fibres are are evaluated by where they were before the motion.
    options.neighbour_skip = test.wants_adjacent() ? 0 : 1;
    do_query(swept, options, result);
    take(result, swept, swept, test, limits, candidates);
    return;
  }
  SweptFibers swept_shape;
  swept_shape.update(shape->before, shape->after, motion_->swept.drift());
  do_query_shape(swept_shape.fibers(), swept, options, result);
  take(result, swept_shape.fibers(), swept, test, limits, candidates);
}

double ProximityEngine::mean_level_volume(std::uint32_t level) const {
  std::vector<NodeBox> boxes;
  level_boxes(level, boxes);
  double sum = 0.0;
  for (const NodeBox& box : boxes) {
    sum += (box.upper - box.lower).prod();
  }
  return boxes.empty() ? 0.0 : sum / static_cast<double>(boxes.size());
}

void ProximityEngine::on_threads(const std::function<void()>& work) const {
  tbb::task_arena(1).execute(work);
}

void nearest_segments(const ProximityEngine& engine, const Eigen::Vector3d& point, std::uint32_t k,
                      QueryResult& result) {
  require_coordinates("point", point);
  if (k == 0) {
    throw std::invalid_argument("k is 0, it must be at least 1");
  }
  QueryOptions options;
  options.type = QueryType::LIMITED;
  options.max_contacts = k;
  options.margin = std::numeric_limits<double>::infinity();
  // A point is a capsule of no length and no radius.
  engine.query_shape(FiberAssembly({point, point}, {0, 2}, {0.0}), options, result);
  sort_by_distance(result.contacts);
}

}  // namespace fiber
