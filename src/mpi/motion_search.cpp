#include "src/mpi/motion_search.hpp"

#include <algorithm>
#include <limits>
#include <utility>

#include "fiber_proximity/geometry/contact_time.hpp"
#include "src/mpi/halo_exchange.hpp"
#include "src/mpi/whole_fiber_pairs.hpp"
#include "src/query/motion_evaluator.hpp"

namespace fiber {
namespace {

bool is_stopped_by_limit(const MotionResult& result) {
  return !result.complete && result.limit_reached;
}

}  // namespace

void MotionSearch::update(const OwnedFibers& fibers) {
  fibers_ = &fibers;
  // Loops are looked for in the halo, too: where others were before says nothing of where they are.
  halo_.assign(FiberRuns());
  halo_after_.assign(FiberRuns());
  ranks_.throw_on_all(error_in(
      [&] { engine_->update_motion(fibers.own().fibers(), fibers.own_after().fibers()); }));
}

/// Appends those of the pairs found that are pairs along whole fibres; segment a is this rank's
/// own.
void MotionSearch::append(const MotionOptions& options, const LocalFibers& fibers_b,
                          MotionResult& found, DistributedMotionResult& result) const {
  const LocalFibers& own = fibers_->own();
  const JoinedPairs joined(fibers_->joined(), options);
  const RankPairs pairs{ranks_, own, halo_, joined};
  const auto append_some = [&](std::vector<MotionContact>& some,
                               std::vector<DistributedMotionContact>& contacts) {
    pairs.keep_those_of_whole_fibers(options, fibers_b, some);
    for (const MotionContact& contact : some) {
      const GlobalSegment a = own.global_id(contact.fiber_a, contact.segment_a);
      const GlobalSegment b = fibers_b.global_id(contact.fiber_b, contact.segment_b);
      contacts.push_back(
          {a.fiber, a.segment, b.fiber, b.segment, contact.lower, contact.upper, contact.certain});
    }
  };
  append_some(found.contacts, result.contacts);
  append_some(found.touching, result.touching);
}

/// Asks about candidates as one process does: this rank's own segment first.
/// @param candidates of a segment of the halo and one of this rank's own
void MotionSearch::evaluate(const MotionOptions& options,
                            const std::vector<MotionContact>& candidates,
                            MotionResult& result) const {
  const LocalFibers& own = fibers_->own();
  const FiberMotion motion_a{own.fibers(), fibers_->own_after().fibers()};
  const FiberMotion motion_b{halo_.fibers(), halo_after_.fibers()};
  for (const MotionContact& candidate : candidates) {
    const SegmentIdPair pair{candidate.fiber_b, candidate.segment_b, candidate.fiber_a,
                             candidate.segment_a};
    if (!(own.global_id(pair.fiber_a, pair.segment_a) <
          halo_.global_id(pair.fiber_b, pair.segment_b))) {
      continue;  // another rank's
    }
    const SegmentMotions motions = motions_of(
        motion_a, motion_b,
        {own.point_of(pair.fiber_a, pair.segment_a), halo_.point_of(pair.fiber_b, pair.segment_b)},
        options.margin);
    const auto ask = [&](double tolerance) { return contact_time(motions, tolerance); };
    ContactTime time = ask(options.tolerance);
    narrow(time, options, ask);
    if (time.hit) {
      (is_there_before(time) ? result.touching : result.contacts)
          .push_back({pair, time.lower, time.upper, time.certain});
    }
  }
}

void MotionSearch::find(const MotionOptions& options, const PerRank<RunSpan>& spans,
                        DistributedMotionResult& result) {
  const Deadline deadline(options.deadline);
  HaloExchange halo(ranks_, fibers_->states(), spans);

  MotionOptions here = options;
  static_cast<PairOptions&>(here) = options_of_stretches(options, fibers_->arc_roundings());
  here.type = MotionType::ALL;
  engine_->query_motion(here, found_);
  append(options, fibers_->own(), found_, result);
  result.complete = found_.complete;
  result.limit_reached = is_stopped_by_limit(found_);

  ranks_.throw_on_all(error_in([&] {
    FiberRuns runs = halo.take();
    halo_.assign(runs);
    runs.nodes = halo.take_after();
    halo_after_.assign(runs);
  }));
  // The engine takes the halo's segment for the first of each pair, here it is the second. Pairs
  // that may be reported are less apart than this, whichever comes first.
  here.margin = reach_of(options);
  here.time_tolerance = std::numeric_limits<double>::infinity();
  here.deadline = deadline.left();
  here.pair_limit = rest_of(options.pair_limit, found_.counts.primitive_tests);
  ranks_.throw_on_all(error_in(
      [&] { engine_->query_motion_shape(halo_.fibers(), halo_after_.fibers(), here, found_); }));
  result.complete = result.complete && found_.complete;
  result.limit_reached = result.limit_reached || is_stopped_by_limit(found_);
  MotionResult across;
  evaluate(options, found_.contacts, across);
  evaluate(options, found_.touching, across);
  append(options, halo_, across, result);
}

}  // namespace fiber
