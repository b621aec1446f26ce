#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "fiber_proximity/query/contact.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// The load of a rank, in any unit.
struct RankLoad {
  double cost = 0.0;                                   ///< of all; 0 if it is not known
  std::function<std::vector<double>()> costs_of_runs;  ///< of each run that it owns
};

/// Estimates what an update and queries took of a rank. It is counted, not timed, so that what else
/// a machine did makes no difference.
/// @param own    the rank's fibres
/// @param counts of its queries
/// @param inner  contacts among its own segments
/// @param across contacts of its own segments (a) and others. All live as long as what is returned
RankLoad load_of(const LocalFibers& own, const QueryCounts& counts,
                 const std::vector<Contact>& inner, const std::vector<Contact>& across);

/// Tells when fibres are to be split anew, the same on all ranks.
class LoadBalance {
 public:
  /// Whether a rank has had too much to do. What a split by costs could not even out is not tried
  /// again: later imbalances are held against what it reached.
  /// @param costs of all ranks since the last update
  bool is_too_uneven(const std::vector<double>& costs);

  /// Notes that fibres were split.
  /// @param by_costs whether by what their pieces had cost: what that reached shows in the next
  ///                 costs
  void note_split(bool by_costs) {
    ++split_count_;
    is_reached_known_ = !by_costs;
    best_imbalance_ = 1.0;
  }

  std::uint64_t split_count() const { return split_count_; }

 private:
  double best_imbalance_ = 1.0;  // the largest cost over the mean that the last split reached
  bool is_reached_known_ = true;
  std::uint64_t split_count_ = 0;
};

}  // namespace fiber
