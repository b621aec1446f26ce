#include "src/query/run_tree_engine.hpp"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

#include "fiber_proximity/query/for_engines/pair_collector.hpp"
#include "src/geometry/swept_fibers.hpp"
#include "src/hierarchy/run_tree_kernels.hpp"
#include "src/query/motion_evaluator.hpp"
#include "src/query/pair_sinks.hpp"
#include "src/query/run_tree_boxes.hpp"
#include "src/query/threads.hpp"

namespace fiber {
namespace {

/// Points that move further than any engine allows are beyond the range of float.
/// @throws std::invalid_argument as SweptFibers
void check_ways(const RunTree& tree, const FiberAssembly& before, const FiberAssembly& after) {
  if (tree.is_unbounded()) {
    SweptFibers().update(before, after, tree.origin_after() - tree.origin());
  }
}

/// A shape's tree beside that of the fibres, which has them where they were: so has the shape's,
/// but for what they have in common.
struct ShapeTree {
  ShapeTree(const FiberAssembly& shape, const RunTree& fibers, const MotionSinceFit& since)
      : approach(since.beyond) {
    tree.build({shape, fibers.origin() + since.drift});
  }

  RunTree tree;
  const Approach approach;
};

// Replacing the candidates of more segments than this part of all takes longer than finding all.
constexpr double max_dirty_part = 0.25;

}  // namespace

RunTreeEngine::RunTreeEngine(const EngineOptions& options)
    : arena_(arena_concurrency(options.threads)), skin_(options.skin) {}

EngineFacts RunTreeEngine::facts() const {
  EngineFacts facts;
  facts.thread_count = static_cast<std::uint32_t>(arena_.max_concurrency());
  facts.memory_bytes = tree_.memory_bytes() + motion_.memory_bytes() + cache_.memory_bytes() +
                       dirty_.memory_bytes() + loops_.memory_bytes();
  // The root, which the tree has no box for, and the levels of the tree from the top down.
  const std::uint32_t levels = tree_.view().level_count;
  facts.level_count = levels == 0 ? 0 : levels + 1;
  return facts;
}

void RunTreeEngine::do_update(const FiberAssembly& fibers, bool same_topology) {
  loops_.reset(fibers);
  arena_.execute([&] {
    if (!same_topology) {
      tree_.build({fibers, hierarchy_origin(fibers)});
      forget(fibers);
      return;
    }
    const bool is_followed = !tree_.moves();
    skin_.end_frame();
    const bool has_motion = is_followed && skin_.asks_for_motion();
    if (has_motion && tree_still_serves(fibers)) {
      return;
    }
    tree_.update({fibers, hierarchy_origin(fibers)});
    if (!is_followed || (has_motion && !moved_.is_known())) {
      forget(fibers);
    } else if (!has_motion) {
      start_anew(fibers, nullptr);
    } else if (!most_still_serve(fibers)) {
      start_anew(fibers, &motion_);
    }
  });
}

/// With a tree that has been fitted: all candidates are looked for anew.
/// @param motion since that was so last; none: not known
void RunTreeEngine::start_anew(const FiberAssembly& fibers, const MotionBound* motion) {
  skin_.begin_stretch(fibers, motion);
  begin_to_serve(fibers);
}

/// The same for fibres of which nothing is known from the frames before.
void RunTreeEngine::forget(const FiberAssembly& fibers) {
  skin_.start();
  motion_.reserve(skin_.may_be_one() ? fibers.point_count() : 0,
                  std::max(fibers.fiber_count(), fibers.radii().size()));
  begin_to_serve(fibers);
}

void RunTreeEngine::begin_to_serve(const FiberAssembly& fibers) {
  ++refit_count_;
  moved_ = MotionSinceFit();
  moved_before_fit_ = 0.0;
  cache_.become(CandidateCache::State::NONE);
  if (skin_.asks_for_motion()) {
    const NodeBox box = run_tree_box(tree_);
    motion_.start(fibers, box.lower, box.upper);
  }
}

/// Whether the points are close enough to where the tree has them; notes how close.
bool RunTreeEngine::tree_still_serves(const FiberAssembly& fibers) {
  // The margin of the pairs that are kept: other queries see for themselves whether these serve
  // them, too.
  const double margin = std::isfinite(cache_.margin()) ? cache_.margin() : 0.0;
  moved_ = motion_.measure(fibers, skin_.skin(), margin);
  const bool serves = moved_.leaves(skin_.skin(), margin) && !skin_.is_over();
  if (serves) {
    skin_.go_on();
  }
  return serves;
}

/// With a tree that has been fitted: if few fibres have moved far, measures their motion from here,
/// and has only their candidates looked for anew.
bool RunTreeEngine::most_still_serve(const FiberAssembly& fibers) {
  if (skin_.is_over() || skin_.skin() == 0.0) {
    return false;
  }
  if (cache_.state() != CandidateCache::State::STALE) {
    dirty_.clear();
  }
  // Those that are far from the limit are left where they are; the others would follow soon.
  const double limit = skin_.skin() / 4.0;
  double of_others = 0.0;
  const std::vector<double>& moved = *motion_.by_fiber();
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    if (moved[fiber] > limit) {
      dirty_.add(fibers, fiber);
    } else {
      of_others = std::max(of_others, moved[fiber]);
    }
  }
  if (static_cast<double>(dirty_.size()) >
      max_dirty_part * static_cast<double>(fibers.segment_count())) {
    dirty_.clear();
    return false;
  }
  for (std::uint32_t fiber = 0; fiber < fibers.fiber_count(); ++fiber) {
    if (moved[fiber] > limit) {
      motion_.restart(fibers, fiber);
    }
  }
  dirty_.fit(fibers, tree_.origin());
  cache_.become(CandidateCache::State::STALE);
  moved_ = MotionSinceFit::within(of_others);
  moved_before_fit_ = of_others;
  skin_.go_on();
  ++refit_count_;
  ++partial_count_;
  return true;
}

void RunTreeEngine::do_query(const FiberAssembly& fibers, const QueryOptions& options,
                             QueryResult& result) const {
  QueryOptions left = options;
  if (options.type == QueryType::ALL) {
    const QueryLimits limits(options);
    if (find_own(fibers, NarrowPhase(fibers, options, &loops_), options, limits, result)) {
      return;
    }
    left.deadline = limits.deadline.left();
  }
  PairCollector collector(fibers, left, result, &loops_);
  searches_.lend([&](ShrinkingSearch& search) {
    search.find(tree_.view(), tree_.view(), since_fit().approach, arena_, collector, result);
  });
}

void RunTreeEngine::do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                                   const QueryOptions& options, QueryResult& result) const {
  const ShapeTree other(shape, tree_, since_fit());
  QueryOptions left = options;
  if (options.type == QueryType::ALL) {
    const QueryLimits limits(options);
    const NarrowPhase test(shape, fibers, options);
    bool is_found = false;
    with_batch([&](ContactBatch& batch) {
      is_found = batch.find(other.tree.view(), tree_.view(), test, other.approach, limits, result);
    });
    if (is_found) {
      return;
    }
    left.deadline = limits.deadline.left();
  }
  PairCollector collector(shape, fibers, left, result);
  searches_.lend([&](ShrinkingSearch& search) {
    search.find(other.tree.view(), tree_.view(), other.approach, arena_, collector, result);
  });
}

void RunTreeEngine::offer_pairs(PairSink& sink, const std::function<bool()>& is_over,
                                QueryCounts& counts) const {
  WideningSink wide(sink, since_fit().approach);
  const RunTreeView& tree = tree_.view();
  find_near_segments_until(is_over, tree, 0, tree.group_count(), tree, wide, counts.node_tests,
                           counts.node_overlaps);
}

void RunTreeEngine::offer_pairs_with(const FiberAssembly& shape, PairSink& sink,
                                     const std::function<bool()>& is_over,
                                     QueryCounts& counts) const {
  const ShapeTree other(shape, tree_, since_fit());
  WideningSink wide(sink, other.approach);
  find_near_segments_until(is_over, other.tree.view(), 0, other.tree.view().group_count(),
                           tree_.view(), wide, counts.node_tests, counts.node_overlaps);
}

/// All contacts of the fibres with each other: from candidates that are kept, if there are such.
/// @return false, with no answer, if more pairs would have to be examined than may be
bool RunTreeEngine::find_own(const FiberAssembly& fibers, const NarrowPhase& test,
                             const QueryOptions& options, const QueryLimits& limits,
                             QueryResult& result) const {
  bool is_found = false;
  with_batch([&](ContactBatch& batch) {
    // Which pairs a length leaves out changes as fibres stretch: such candidates cannot be kept.
    if (options.neighbour_skip_length.value_or(0.0) == 0.0) {
      const auto estimate = [&](double skin, double max_pairs) {
        return batch.estimate(tree_.view(), test, options.margin + skin, max_pairs, skin == 0.0);
      };
      skin_.decide(fibers, std::cref(estimate));  // which allocates nothing
      is_found = skin_.keeps_pairs() && moved_.leaves(skin_.skin(), options.margin) &&
                 find_kept(test, options, limits, batch, result);
    }
    is_found = is_found ||
               batch.find(tree_.view(), tree_.view(), test, since_fit().approach, limits, result);
  });
  return is_found;
}

/// The same from candidates that are kept, or will be; false if there are too many.
bool RunTreeEngine::find_kept(const NarrowPhase& test, const QueryOptions& options,
                              const QueryLimits& limits, ContactBatch& batch,
                              QueryResult& result) const {
  QueryLimits kept = limits;
  kept.pairs = std::min(limits.pairs, skin_.max_pairs());
  const Candidates candidates = current_candidates(test, options, kept, batch, result.counts);
  if (candidates.found == ContactBatch::Found::TOO_MANY) {
    skin_.give_up();
    return false;
  }
  batch.evaluate(*candidates.keys, candidates.found == ContactBatch::Found::ALL, test, limits,
                 result);
  return true;
}

/// Candidates that serve until motion exceeds the skin: kept ones, as far as there are such.
RunTreeEngine::Candidates RunTreeEngine::current_candidates(const NarrowPhase& test,
                                                            const QueryOptions& options,
                                                            const QueryLimits& limits,
                                                            ContactBatch& batch,
                                                            QueryCounts& counts) const {
  using Found = ContactBatch::Found;
  if (const CandidateCache::Keys keys = cache_.find(options, CandidateCache::State::CURRENT)) {
    return {keys, keys->size() > limits.pairs ? Found::TOO_MANY : Found::ALL};
  }
  // Since the tree was fitted, two segments can each have come back by what they had moved before.
  const double reach = options.margin + skin_.skin() + 2.0 * moved_before_fit_;
  const CandidateCache::Keys old = cache_.find(options, CandidateCache::State::STALE);
  const CandidateCache::Keys keys = cache_.make();
  const Found found =
      old != nullptr
          ? batch.replace(*old, dirty_, tree_.view(), test, reach, limits, *keys, counts)
          : batch.collect(tree_.view(), tree_.view(), test, reach, limits, false, *keys, counts);
  if (found == Found::ALL) {
    cache_.keep(options, keys);
  }
  return {keys, found};
}

/// The tree holds what segments that move come by: more closely than swept ones would.
void RunTreeEngine::do_update_motion(const FiberAssembly& before, const FiberAssembly& after,
                                     bool same_topology) {
  require_same_topology(before, after);
  loops_.reset(before);
  arena_.execute([&] {
    const Eigen::Vector3d origin = hierarchy_origin(before);
    const TreeFibers fibers(before, after, origin, origin + drift_of(before, after));
    if (same_topology) {
      tree_.update(fibers);
    } else {
      tree_.build(fibers);
    }
    forget(before);
  });
  check_ways(tree_, before, after);
}

void RunTreeEngine::do_find_candidates(const FiberMotion* shape, const NarrowPhase& test,
                                       const QueryLimits& limits,
                                       MotionCandidates& candidates) const {
  RunTree shape_tree;
  if (shape != nullptr) {
    require_same_topology(shape->before, shape->after);
    shape_tree.build({shape->before, shape->after, tree_.origin(), tree_.origin_after()});
    check_ways(shape_tree, shape->before, shape->after);
  }
  const RunTree& a = shape != nullptr ? shape_tree : tree_;
  with_batch([&](ContactBatch& batch) {
    const ContactBatch::Found found =
        batch.collect(a.view(), tree_.view(), test, test.margin(), limits, true, candidates.keys,
                      candidates.counts);
    candidates.are_all = found != ContactBatch::Found::SOME;
    candidates.are_too_many = found == ContactBatch::Found::TOO_MANY;
  });
}

template <class Call>
void RunTreeEngine::with_batch(const Call& call) const {
  batches_.lend([&](ContactBatch& batch) { arena_.execute([&] { call(batch); }); });
}

void RunTreeEngine::level_boxes(std::uint32_t level, std::vector<NodeBox>& boxes) const {
  run_tree_boxes(tree_, since_fit(), level, boxes);
}

}  // namespace fiber
