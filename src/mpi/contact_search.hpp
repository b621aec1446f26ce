#pragma once

#include <cstdint>
#include <functional>
#include <limits>
#include <memory>
#include <vector>

#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_runs.hpp"
#include "src/mpi/load_balance.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/owned_fibers.hpp"
#include "src/query/run_tree_engine.hpp"

namespace fiber {

/// Looks for the pairs that a rank reports: those of its own segments with each other, and with
/// segments of others that come after them.
class ContactSearch {
 public:
  static constexpr std::uint64_t no_limit = std::numeric_limits<std::uint64_t>::max();

  ContactSearch(const Communicator& ranks, const EngineOptions& options)
      : ranks_(ranks), engine_(std::make_unique<RunTreeEngine>(options)) {}

  /// Makes these fibres those that are looked at; they must live until the next update.
  void update(const OwnedFibers& fibers);

  /// Takes the same fibres, which have moved to another place in memory.
  void follow(const OwnedFibers& fibers) { engine_->update(fibers.own().fibers()); }

  /// Forgets them.
  void clear();

  /// Finds the so many closest pairs of this rank's own segments that the options ask for; if there
  /// are more, others may be among them. Those of an earlier query are gone. Collective.
  /// @param options FIRST: any one pair; all other types are one
  /// @param result  gets no contacts
  void find_inner(const QueryOptions& options, std::uint64_t count, DistributedResult& result);

  /// Finds all pairs within the margin of a segment of this rank's own and one of others, beside
  /// those that are found. Collective.
  /// @param result  gets no contacts
  /// @throws std::invalid_argument on every rank if one has more than an assembly may have
  void find_across(const FiberRuns& halo, const QueryOptions& options, DistributedResult& result);

  /// Finds of each pair of fibres the closest pair of segments of all ranks, where this rank
  /// reports it: instead of the above. Collective.
  /// @param halo_within brings the halo of a margin [m]. Collective
  /// @param result      gets no contacts
  /// @throws std::invalid_argument on every rank if one has more than an assembly may have
  void find_closest_of_fibers(const std::function<FiberRuns(double margin)>& halo_within,
                              const QueryOptions& options, DistributedResult& result);

  /// All contacts that are found, sorted.
  void write(std::vector<DistributedContact>& contacts) const;

  std::uint64_t halo_segments() const { return halo_.fibers().segment_count(); }

  /// Work of this rank since the last update.
  const QueryCounts& counts() const { return counts_; }

  /// About what the last update and the queries since then took of this rank.
  RankLoad load() const;

 private:
  QueryOptions options_here(const QueryOptions& options) const;
  double rounding_across() const;

  const Communicator& ranks_;
  std::unique_ptr<RunTreeEngine> engine_;
  const OwnedFibers* fibers_ = nullptr;
  LocalFibers halo_;
  QueryCounts counts_;

  QueryResult inner_;            // contacts are sorted
  std::vector<Contact> across_;  // sorted
  QueryResult candidates_;       // work memory
};

}  // namespace fiber
