#pragma once

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/loop_questions.hpp"

namespace fiber {

/// Looks for the pairs that a rank reports: those of its own segments with each other, and with
/// segments of others that come after them.
class RankSearch {
 public:
  static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

  explicit RankSearch(const EngineOptions& options) : engine_(make_engine("run_tree", options)) {}

  /// Forgets the fibres.
  void clear() { reach_ = -1.0; }

  /// Gets what pairs within the margin [m] need of the fibres that the ranks own. Collective.
  /// @throws std::invalid_argument on every rank if one would hold too much
  void reach(const Communicator& ranks, const FiberRuns& own, double margin);

  /// [m] The margin up to which all pairs are known; -1 for none.
  double reach() const { return reach_; }

  std::uint64_t halo_segments() const { return halo_segments_; }

  /// The so many closest pairs of this rank that the options ask for; if there are more, a few
  /// others may be among them. Of those further apart than reach() some may be missing. Collective.
  /// @param options       FIRST: any one pair; all other types are one
  /// @param arc_roundings [m] most that arc lengths are rounded by, in units of ε
  /// @param result        contacts in any order
  void find(const Communicator& ranks, const FiberRuns& own, double arc_roundings,
            const QueryOptions& options, std::uint64_t count, DistributedResult& result);

 private:
  QueryOptions options_here(const QueryOptions& options, double arc_roundings) const;
  bool is_left_out(const QueryOptions& options, const Contact& contact) const;
  void take(const Communicator& ranks, const FiberRuns& own, const QueryOptions& options,
            std::vector<DistributedContact>& contacts) const;

  std::unique_ptr<ProximityEngine> engine_;
  LocalFibers local_;
  std::uint64_t halo_segments_ = 0;
  double reach_ = -1.0;
  QueryResult found_;  // work memory
};

}  // namespace fiber
