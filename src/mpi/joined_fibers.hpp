#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "fiber_proximity/mpi/distributed_engine.hpp"
#include "fiber_proximity/query/for_engines/loop_test.hpp"
#include "src/mpi/communicator.hpp"
#include "src/mpi/global_joints.hpp"
#include "src/mpi/local_fibers.hpp"
#include "src/mpi/piece_routes.hpp"

namespace fiber {

/// The closed and joined fibres of which this rank owns a segment, and all that are joined with
/// these: whole, because which pairs of segments are none is decided along the whole graph. Fibres
/// that are neither closed nor joined are not among them, and cost nothing here.
class JoinedFibers {
 public:
  /// Whether parts with this topology are joined as the last ones were.
  bool is_of(const FiberTopology& topology) const {
    return topology.closed == topology_.closed && topology.joints == topology_.joints &&
           topology.joint_tolerance == topology_.joint_tolerance;
  }

  /// Takes what is joined among other parts. Collective.
  /// @param topology see part_topology()
  /// @throws std::invalid_argument as GlobalJoints
  void set_parts(const Communicator& ranks, const FiberAssembly& parts,
                 const std::vector<FiberPart>& names, const FiberTopology& topology);

  /// Finds which fibres go to which ranks. Collective.
  /// @param routes tell who owns the pieces of the parts
  /// @throws std::invalid_argument on every rank if one would hold too many points
  void set_owners(const Communicator& ranks, const FiberAssembly& parts,
                  const std::vector<FiberPart>& names, const PieceRoutes& routes);

  /// Sends the points of all parts to the ranks that need them. Collective.
  /// @throws std::invalid_argument on every rank for points of a joint that do not meet, and a
  ///         closed fibre whose last point is not its first one
  void send_nodes(const Communicator& ranks, const FiberAssembly& parts);

  /// Joined points of the fibres that a rank owns, as DistributedFibers::topology has it.
  FiberTopology topology_of(const LocalFibers& own) const;

  /// The fibres, as an assembly in the order of their numbers: they are open, and a closed one has
  /// a joint of its two ends.
  const FiberAssembly& fibers() const { return fibers_.fibers(); }

  /// The loop test of fibers().
  const LoopTest& loops() const { return loops_; }

  /// The places of two segments among fibers(), the first one first by name; none if one is not
  /// there, so that no way through a joint leads from one to the other.
  std::optional<PointPair> points_of(const GlobalSegment& a, const GlobalSegment& b) const;

 private:
  /// Parts of one component, by ranks.
  struct ComponentAtRank {
    std::uint64_t component = 0;
    int rank = 0;
  };

  bool is_closed(std::uint64_t fiber) const;
  bool is_closed_part(std::size_t part) const {
    return !topology_.closed.empty() && topology_.closed[part] != 0;
  }
  std::optional<std::uint32_t> place_of(std::uint64_t fiber) const;
  std::vector<ComponentAtRank> exchange_owners(const Communicator& ranks,
                                               std::vector<ComponentAtRank> owners) const;
  void require_what_is_joined_meets() const;
  std::shared_ptr<const FiberGraph> make_graph() const;

  FiberTopology topology_;  // of the parts that this rank brings
  GlobalJoints joints_;
  PerRank<std::uint32_t> parts_for_;  // by rank, those of this rank's parts that it needs
  LocalFibers fibers_;
  std::vector<std::uint64_t> closed_;        // of fibers_, by number, sorted
  std::shared_ptr<const FiberGraph> graph_;  // of fibers_, none before their first points
  LoopTest loops_;
};

}  // namespace fiber
