#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_chains.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/piece_boxes.hpp"
#include "src/mpi/rank_load.hpp"

namespace fiber {

/// The fibres of all ranks, cut into pieces of a few segments; each rank owns those that the split
/// gives to it.
class RankFibers {
 public:
  /// Takes the parts that the ranks bring. Of the same parts as before only the points go to their
  /// owners, unless the ranks' costs differ too much: then they are split anew. Collective.
  /// @param load of this rank since the last update
  /// @throws std::invalid_argument on every rank as DistributedEngine::update()
  void update(const Communicator& ranks, const FiberAssembly& parts,
              const std::vector<FiberPart>& names, const RankLoad& load = {}) {
    take(ranks, parts, nullptr, names, load);
  }

  /// The same of fibres that move: of one topology before and after.
  void update_motion(const Communicator& ranks, const FiberAssembly& before,
                     const FiberAssembly& after, const std::vector<FiberPart>& names) {
    take(ranks, before, &after, names, {});
  }

  /// Makes what each rank owns the parts that it brings. There must be fibres, and no motion.
  /// Collective.
  DistributedFibers adopt(const Communicator& ranks);

  /// Points of this rank's parts that belong to others.
  std::uint64_t sent_points() const { return sent_points_; }

  bool empty() const { return !has_fibers_; }

  bool do_move() const { return do_move_; }

  /// What this rank owns, before the motion if there is one.
  const LocalFibers& own() const { return own_; }
  const LocalFibers& own_after() const { return own_after_; }

  FiberStates states() const { return {own_, do_move_ ? &own_after_ : nullptr}; }

  /// How far points have come, of all ranks.
  struct Displacement {
    std::uint64_t epoch = 0;  // since when they have gone it
    double length = 0.0;      // [m] that no point has gone further than
    double last = 0.0;        // [m] with the last update
  };

  /// The same on all ranks. An epoch begins where it is not known how far points have come: where
  /// fibres are split, have other radii, or go a way themselves.
  const Displacement& displacement() const { return displacement_; }

  /// Boxes of own(), fitted to where they are.
  const PieceBoxes& fit_boxes();

  /// Around own(), and little more. Boxes must have been fitted since the epoch began, to some.
  PlainBox around() const;

  /// [m] Most that arc lengths of all fibres are rounded by, in units of ε.
  double arc_roundings() const { return arc_roundings_; }

  /// How often fibres were split among the ranks.
  std::uint64_t split_count() const { return split_count_; }

 private:
  bool is_as_before(const FiberAssembly& parts, const std::vector<FiberPart>& names) const;
  void name_parts(const Communicator& ranks, const FiberAssembly& parts,
                  const std::vector<FiberPart>& names);
  bool is_too_uneven(const std::vector<double>& costs);
  void split(const Communicator& ranks, const FiberAssembly& parts,
             const std::vector<double>& costs);
  void hand_over(const Communicator& ranks);
  std::vector<double> costs_of_pieces(const Communicator& ranks, const RankLoad& load) const;
  void send_nodes(const Communicator& ranks, const FiberAssembly& parts,
                  const std::vector<double>& arcs, LocalFibers& owned) const;
  void take(const Communicator& ranks, const FiberAssembly& parts, const FiberAssembly* after,
            const std::vector<FiberPart>& names, const RankLoad& load);

  // Of the parts that this rank brings:
  std::vector<FiberPart> names_;
  std::vector<std::uint32_t> offsets_;
  std::optional<FiberChains> chains_;
  std::vector<int> destinations_;  // of their pieces

  LocalFibers own_;
  LocalFibers own_after_;
  PieceBoxes boxes_;
  std::uint64_t boxes_hand_over_ = 0;  // hand_over_count_ of the fibres that they are of
  Displacement boxes_displacement_;    // of these when they were fitted
  Displacement displacement_;
  std::vector<std::size_t> first_of_rank_;  // number of the first run that each rank sends
  double arc_roundings_ = 0.0;
  std::uint64_t split_count_ = 0;
  std::uint64_t hand_over_count_ = 0;
  std::uint64_t sent_points_ = 0;
  double best_imbalance_ = 1.0;  // most of the ranks' costs beside the mean, by the last split
  bool evenness_is_known_ = true;
  bool has_fibers_ = false;
  bool do_move_ = false;
};

}  // namespace fiber
