#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/fiber_chains.hpp"
#include "src/mpi/named_fibers.hpp"
#include "src/mpi/piece_boxes.hpp"

namespace fiber {

/// The fibres of all ranks, cut into pieces of a few segments; each rank owns those that the split
/// gives to it.
class RankFibers {
 public:
  /// Takes the parts that the ranks bring. Of the same parts as before only the points go to their
  /// owners, unless the ranks' costs differ too much: then they are split anew. Collective.
  /// @param cost of what this rank owns, in any unit; 0 if it is not known
  /// @throws std::invalid_argument on every rank as DistributedEngine::update()
  void update(const Communicator& ranks, const FiberAssembly& parts,
              const std::vector<FiberPart>& names, double cost);

  bool empty() const { return !has_fibers_; }

  /// What this rank owns.
  const NamedFibers& own() const { return own_; }

  const PieceBoxes& boxes() const { return boxes_; }  ///< of own()

  /// [m] Most that arc lengths of all fibres are rounded by, in units of ε.
  double arc_roundings() const { return arc_roundings_; }

  /// How often fibres were split among the ranks.
  std::uint64_t split_count() const { return split_count_; }

 private:
  bool is_as_before(const FiberAssembly& parts, const std::vector<FiberPart>& names) const;
  bool is_too_uneven(const std::vector<double>& costs);
  void split(const Communicator& ranks, const FiberAssembly& parts,
             const std::vector<double>& rank_weights);
  void send_nodes(const Communicator& ranks, const FiberAssembly& parts,
                  const std::vector<double>& arcs);

  // Of the parts that this rank brings:
  std::vector<FiberPart> names_;
  std::vector<std::uint32_t> offsets_;
  std::optional<FiberChains> chains_;
  std::vector<int> destinations_;  // of their pieces

  NamedFibers own_;
  PieceBoxes boxes_;
  std::vector<std::size_t> first_of_rank_;  // number of the first run that each rank sends
  double arc_roundings_ = 0.0;
  std::uint64_t split_count_ = 0;
  double reached_ = 1.0;  // most of the ranks' costs beside the mean, by the last split
  bool evenness_is_known_ = true;
  bool has_fibers_ = false;
};

}  // namespace fiber
