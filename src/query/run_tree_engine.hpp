#pragma once

#include <tbb/task_arena.h>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/query/for_engines/loop_test.hpp"
#include "src/hierarchy/motion_bound.hpp"
#include "src/hierarchy/run_tree.hpp"
#include "src/query/candidate_cache.hpp"
#include "src/query/contact_batch.hpp"
#include "src/query/idle_memory.hpp"
#include "src/query/shrinking_search.hpp"
#include "src/query/skin_choice.hpp"

namespace fiber {

/// `run_tree`, the fast engine. With a skin, which it chooses itself unless there is a fixed one,
/// the tree stays where it is while points move by at most half of it: all bounds are larger by
/// what they have moved, and the candidates of one query serve the next ones. When few fibres have
/// moved further, only their candidates are looked for anew.
class FIBER_PROXIMITY_EXPORT RunTreeEngine final : public ProximityEngine {
 public:
  /// @throws std::invalid_argument for a skin that is negative or not finite
  explicit RunTreeEngine(const EngineOptions& options);

  EngineFacts facts() const override;
  void level_boxes(std::uint32_t level, std::vector<NodeBox>& boxes) const override;

  /// Offers the pairs of segments of its fibres that may come within the sink's bound, each once,
  /// while the sink wants more and not all is over, which is asked often. One thread.
  void offer_pairs(PairSink& sink, const std::function<bool()>& is_over, QueryCounts& counts) const;

  /// Offers pairs of a segment of the shape (a) and one of its fibres (b).
  void offer_pairs_with(const FiberAssembly& shape, PairSink& sink,
                        const std::function<bool()>& is_over, QueryCounts& counts) const;

  /// [m] The skin that there is now: the fixed one, or that chosen last.
  double skin() const { return skin_.skin(); }

  /// How often updates have moved the tree.
  std::uint64_t refit_count() const { return refit_count_; }

  /// How often of these most candidates could be kept.
  std::uint64_t partial_count() const { return partial_count_; }

 protected:
  void do_update(const FiberAssembly& fibers, bool same_topology) override;
  void do_query(const FiberAssembly& fibers, const QueryOptions& options,
                QueryResult& result) const override;
  void do_query_shape(const FiberAssembly& shape, const FiberAssembly& fibers,
                      const QueryOptions& options, QueryResult& result) const override;
  void do_update_motion(const FiberAssembly& before, const FiberAssembly& after,
                        bool same_topology) override;
  void do_find_candidates(const FiberMotion* shape, const NarrowPhase& test,
                          const QueryLimits& limits, MotionCandidates& candidates) const override;
  const LoopTest* loops_before() const override { return &loops_; }
  void on_threads(const std::function<void()>& work) const override { arena_.execute(work); }

 private:
  bool tree_still_serves(const FiberAssembly& fibers);
  bool most_still_serve(const FiberAssembly& fibers);
  void start_anew(const FiberAssembly& fibers, const MotionBound* motion);
  void forget(const FiberAssembly& fibers);
  void begin_to_serve(const FiberAssembly& fibers);
  /// The motion of the fibres since the tree was fitted.
  MotionSinceFit since_fit() const {
    return moved_before_fit_ > 0.0 ? MotionSinceFit::within(moved_.beyond + moved_before_fit_)
                                   : moved_;
  }

  struct Candidates {
    CandidateCache::Keys keys;
    ContactBatch::Found found;
  };
  Candidates current_candidates(const NarrowPhase& test, const QueryOptions& options,
                                const QueryLimits& limits, ContactBatch& batch,
                                QueryCounts& counts) const;
  bool find_own(const FiberAssembly& fibers, const NarrowPhase& test, const QueryOptions& options,
                const QueryLimits& limits, QueryResult& result) const;
  bool find_kept(const NarrowPhase& test, const QueryOptions& options, const QueryLimits& limits,
                 ContactBatch& batch, QueryResult& result) const;

  /// Calls with memory that queries which run at the same time do not share.
  template <class Call>
  void with_batch(const Call& call) const;

  mutable tbb::task_arena arena_;
  mutable SkinChoice skin_;
  RunTree tree_;
  MotionBound motion_;
  MotionSinceFit moved_;           // since motion is measured
  double moved_before_fit_ = 0.0;  // [m] of that when the tree was fitted: without a drift
  std::uint64_t refit_count_ = 0;
  std::uint64_t partial_count_ = 0;
  mutable CandidateCache cache_;
  DirtySegments dirty_;  // what makes the kept candidates STALE
  LoopTest loops_;
  mutable IdleMemory<ContactBatch> batches_;
  mutable IdleMemory<ShrinkingSearch> searches_;
};

}  // namespace fiber
