#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/joined_fibers.hpp"
#include "src/mpi/load_balance.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/piece_boxes.hpp"
#include "src/mpi/piece_routes.hpp"

namespace fiber {

/// How far points of all ranks have moved, the same on all ranks.
struct Displacement {
  /// Counts how often pieces changed their owners.
  std::uint64_t layout = 0;

  /// Counts how often it was not known how far points had moved: after a change of owners or radii,
  /// and after motions.
  std::uint64_t epoch = 0;

  double length = 0.0;  ///< [m] no point has moved further since the epoch began
  double last = 0.0;    ///< [m] nor further than this with the last update
};

/// The fibres that this rank owns, of those that all ranks bring.
class OwnedFibers {
 public:
  /// Takes the parts that the ranks bring. Of the same parts as before only the points go to their
  /// owners, unless the ranks' costs differ too much: then they are split anew. Collective.
  /// @param topology what is given of it beside the parts
  /// @param load     of this rank since the last update
  /// @throws std::invalid_argument on every rank as DistributedEngine::update()
  void update(const Communicator& ranks, const FiberAssembly& parts,
              const std::vector<FiberPart>& names, const FiberTopology& topology = {},
              const RankLoad& load = {}) {
    take(ranks, parts, nullptr, names, topology, load);
  }

  /// Takes parts that move: they have the same numbers of points before and after.
  void update_motion(const Communicator& ranks, const FiberAssembly& before,
                     const FiberAssembly& after, const std::vector<FiberPart>& names,
                     const FiberTopology& topology) {
    take(ranks, before, &after, names, topology, {});
  }

  /// Makes what each rank owns the parts that it brings. There must be fibres, and no motion.
  /// Collective.
  DistributedFibers adopt(const Communicator& ranks);

  /// Points of this rank's parts that other ranks own.
  std::uint64_t sent_points() const { return routes_.sent_points(); }

  bool empty() const { return !has_fibers_; }

  bool do_move() const { return do_move_; }

  /// The fibres that this rank owns, before the motion if there is one.
  const LocalFibers& own() const { return own_; }
  const LocalFibers& own_after() const { return own_after_; }

  /// Those that are closed or joined, whole; before the motion if there is one.
  const JoinedFibers& joined() const { return joined_; }

  FiberStates states() const { return {own_, do_move_ ? &own_after_ : nullptr}; }

  const Displacement& displacement() const { return displacement_; }

  /// Boxes of own(), fitted to where they are.
  const PieceBoxes& fit_boxes();

  /// A box around own(), hardly larger. Boxes must have been fitted since the epoch began, to some.
  Box3d around() const;

  /// [m] The largest rounding error of arc lengths of all fibres, in units of ε.
  double arc_roundings() const { return arc_roundings_; }

  /// How often fibres were split among the ranks.
  std::uint64_t split_count() const { return balance_.split_count(); }

 private:
  void take(const Communicator& ranks, const FiberAssembly& parts, const FiberAssembly* after,
            const std::vector<FiberPart>& names, const FiberTopology& given, const RankLoad& load);
  void take_runs(const Communicator& ranks);
  void begin_epoch() { displacement_ = {displacement_.layout, displacement_.epoch + 1}; }

  PieceRoutes routes_;
  LoadBalance balance_;
  LocalFibers own_;
  LocalFibers own_after_;
  JoinedFibers joined_;
  Displacement displacement_;
  PieceBoxes boxes_;
  Displacement boxes_fitted_;  // the displacement when boxes were fitted
  double arc_roundings_ = 0.0;
  bool has_fibers_ = false;
  bool do_move_ = false;
};

}  // namespace fiber
