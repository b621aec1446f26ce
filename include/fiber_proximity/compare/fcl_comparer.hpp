#pragma once

#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/compare/comparison.hpp"
#include "fiber_proximity/compare/fcl_broad_phase.hpp"
#include "fiber_proximity/query/engine.hpp"

namespace fiber {

/// Runs FCL beside an engine, frame by frame: its trees are kept, and refitted to fibres that only
/// moved. For one thread at a time.
class FclComparer {
 public:
  /// All pairs within the margin by the engine and by FCL in both styles, the user's first.
  /// @param engine updated to these fibres
  /// @param options type, tolerances and deadline do not count: all pairs are asked for
  /// @throws std::invalid_argument for options that do not validate or an infinite margin
  Comparison compare(const FiberAssembly& fibers, const ProximityEngine& engine,
                     const QueryOptions& options);

 private:
  void prepare(const FiberAssembly& fibers, double margin);
  void ask_engine(const FiberAssembly& fibers, const ProximityEngine& engine,
                  const QueryOptions& options, Comparison& comparison);
  void ask_user_style(const FiberAssembly& fibers, const QueryOptions& options,
                      StyleComparison& style);
  void ask_best_style(const FiberAssembly& fibers, const QueryOptions& options,
                      StyleComparison& style);

  double margin_ = 0.0;                 // [m] of the trees
  std::vector<std::uint32_t> offsets_;  // of the fibres they hold; empty: none
  bool same_topology_ = false;
  std::unique_ptr<FclCapsules> capsules_;
  std::unique_ptr<FclBroadPhase> boxes_;

  // Members for their memory.
  QueryResult result_;
  std::vector<FclDistance> distances_;
  std::vector<PairAnswered> ours_;
  std::vector<PairAnswered> fcl_;
};

}  // namespace fiber
