#pragma once

#include <cstdint>
#include <limits>
#include <optional>
#include <vector>

#include "fiber_proximity/query/for_engines/loop_test.hpp"
#include "fiber_proximity/query/for_engines/narrow_phase.hpp"
#include "src/mpi/closest_of_fibers.hpp"
#include "src/mpi/global_segments.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/loop_questions.hpp"
#include "src/mpi/whole_fiber_pairs.hpp"
#include "src/query/run_tree_engine.hpp"

namespace fiber {

/// FIBER_PAIRS over ranks: of each pair of fibres the closest pair of segments among those that
/// this rank reports. Only pairs closer than what is known of their fibres are looked at, and asked
/// about where it takes others to know if there is a loop between them.
class FiberPairSearch {
 public:
  /// @param pairs   of this rank; their halo gets what others send
  /// @param engine  has the rank's own fibres
  /// @param options those of the query
  /// @param here    the same for stretches of fibres
  FiberPairSearch(const RankPairs& pairs, const RunTreeEngine& engine, const QueryOptions& options,
                  const QueryOptions& here);

  /// Looks for pairs among own segments. Collective.
  /// @return [m] how close segments of others must be to matter
  double find_inner();

  /// Looks for pairs with segments of the halo, which has arrived, and for pairs that this rank
  /// could not decide before. Collective.
  void find_across();

  /// Writes the pairs found, sorted: those among own segments, and those with the halo.
  void write(std::vector<Contact>& inner, std::vector<Contact>& across) const;

  bool is_complete() const { return !is_over_; }
  bool limit_reached() const { return limit_reached_; }
  double others_lower() const { return others_lower_; }
  const QueryCounts& counts() const { return counts_; }

 private:
  class Sink;

  /// Segments that are near: of this rank, and of this rank or of the halo.
  struct Pair {
    PointPair points;
    GlobalSegment a;
    GlobalSegment b;
    bool is_across = false;
  };
  struct OpenPair : Pair {
    double distance = 0.0;  // [m]
    double lower = 0.0;     // [m] of the true gap

    PairKey key() const { return {distance, a, b}; }
  };

  void look();
  void offer_inner(PointPair points);
  void offer_across(PointPair points);
  bool may_be_pair(const Pair& pair) const;
  /// Whether a loop along its fibre decides about the pair, which is of no joined fibres.
  bool needs_loop(const Pair& pair) const {
    return options_.needs_loops() && pair.a.fiber == pair.b.fiber &&
           !pairs_.joined.points_of(pair.a, pair.b);
  }
  void consider(const Pair& pair);
  void keep(const Pair& pair, const Contact& contact);
  bool is_left_out(const Pair& pair, const Contact& contact);
  std::optional<PointPair> on_one_stretch(const Pair& pair);
  bool is_ruled_out(PointPair along) const;
  bool makes_loop(PointPair along, const PairDistance& distance);
  void join_halo();
  void ask_about_loops();
  LoopQuestion question_about(const Pair& pair) const;
  std::vector<OpenPair> take_closest(std::size_t max_per_fiber);
  void drop_those_beaten();
  const NarrowPhase& test_of(const Pair& pair) const {
    return pair.is_across ? *across_test_ : inner_test_;
  }
  bool is_closer(const PairKey& key);
  void take_loop_steps(std::uint64_t loop_steps);
  bool takes_pair();
  bool is_over();
  void leave_out(double lower) { others_lower_ = std::min(others_lower_, lower); }

  const RankPairs pairs_;
  const Communicator& ranks_;
  const LocalFibers& own_;
  const RunTreeEngine& engine_;
  const LocalFibers& halo_;
  const QueryOptions& options_;
  const Deadline deadline_;
  const NarrowPhase inner_test_;
  std::optional<NarrowPhase> across_test_;  // once there is a halo
  const GlobalSegments own_ids_;
  GlobalSegments halo_ids_;

  ClosestOfFibers closest_;
  // Own segments and those of the halo together, where loops need them:
  LocalFibers joined_;
  std::optional<LoopTest> loops_;     // of these
  std::uint32_t joined_stretch_ = 0;  // that of the pair before

  // Own segments of one fibre that are on two stretches wait for the halo. Before it a few of them
  // may be known to make a loop, which is a bound.
  KnownRuns own_runs_;
  std::uint64_t tries_left_;
  bool has_split_fibers_ = false;

  std::vector<OpenPair> open_;  // pairs if there is a loop between them
  std::uint64_t pairs_left_;
  std::uint32_t steps_ = 0;
  bool is_over_ = false;
  bool limit_reached_ = false;
  double others_lower_ = std::numeric_limits<double>::infinity();
  QueryCounts counts_;
};

}  // namespace fiber
