#pragma once

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_chains.hpp"
#include "src/mpi/local_fibers.hpp"

namespace fiber {

/// The parts that a rank brings, cut into pieces of a few segments, and the owner of each piece.
/// All functions but is_of(), for_each_owner() and sent_points() are collective.
class PieceRoutes {
 public:
  /// Whether these are the same parts as before; their points may have moved.
  bool is_of(const FiberAssembly& parts, const std::vector<FiberPart>& names) const {
    return offsets_ == parts.offsets() && names_ == names;
  }

  /// Takes other parts, whose pieces have no owners yet.
  /// @throws std::invalid_argument on every rank where the parts do not make whole fibres
  void set_parts(const Communicator& ranks, const FiberAssembly& parts,
                 const std::vector<FiberPart>& names);

  /// Lengths from the start of whole fibres to each piece.
  /// @throws std::invalid_argument on every rank if a part does not start where the one before ends
  ArcLengths arc_lengths(const Communicator& ranks, const FiberAssembly& parts) const;

  /// Gives the pieces to owners, so that all have about as much to do.
  /// @param costs of the pieces; empty: as much as they have segments
  void split(const Communicator& ranks, const FiberAssembly& parts,
             const std::vector<double>& costs);

  /// Makes this rank the owner of all pieces that it brings.
  void keep_all(const Communicator& ranks);

  /// Calls with the part and the owner of each piece that this rank brings.
  template <class Call>
  void for_each_owner(const Call& call) const {
    for (std::size_t i = 0; i < pieces_.size(); ++i) {
      call(pieces_[i].part, owners_[i]);
    }
  }

  /// Tells the owners which pieces they get. Their nodes follow with send_nodes().
  /// @return the pieces that this rank owns, in the order in which ranks send them
  std::vector<FiberRun> send_runs(const Communicator& ranks);

  /// Sends the nodes of all pieces to their owners, in slices.
  /// @param arcs  [m] lengths to the pieces
  /// @param owned fibres of this rank, open: what send_runs() returned
  /// @throws std::invalid_argument on every rank if points or radii are not valid
  void send_nodes(const Communicator& ranks, const FiberAssembly& parts,
                  const std::vector<double>& arcs, LocalFibers& owned) const;

  /// Asks the owners what the pieces of this rank cost.
  /// @param of_runs costs of the runs that this rank owns
  std::vector<double> collect_costs(const Communicator& ranks, const LocalFibers& owned,
                                    const std::vector<double>& of_runs) const;

  /// Points of this rank's parts that other ranks own.
  std::uint64_t sent_points() const { return sent_points_; }

 private:
  /// Segments of a part that follow each other.
  struct Piece {
    std::uint32_t part = 0;
    std::uint32_t begin = 0;  // along the part
    std::uint32_t count = 0;
  };

  std::uint32_t first_point(const Piece& piece) const { return offsets_[piece.part] + piece.begin; }

  std::vector<FiberPart> names_;
  std::vector<std::uint32_t> offsets_;
  std::vector<Piece> pieces_;  // part by part
  std::optional<FiberChains> chains_;
  std::vector<int> owners_;                 // of the pieces, part by part
  std::vector<std::size_t> first_of_rank_;  // number of the first run that each rank sends
  std::uint64_t sent_points_ = 0;
};

}  // namespace fiber
