#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// Segments that a rank has, its own ones or its halo, as an assembly with global ids. Consecutive
/// runs are joined to one fibre here, and all are in the order of contacts, so that a pair has the
/// same first segment everywhere.
class LocalFibers {
 public:
  /// Takes other runs with their nodes.
  /// @throws std::invalid_argument as the next ones
  void assign(const FiberRuns& set);

  /// Takes other runs, whose nodes are all to be placed.
  /// @throws std::invalid_argument for more points than an assembly may have; there are none then
  void assign(std::vector<FiberRun> runs);

  /// Begins to move the nodes of the same runs.
  void open();

  /// Sets the nodes of the run that was given as number `number`, and its arc length [m].
  /// @return the end of its nodes
  const FiberNode* place(std::size_t number, double arc, const FiberNode* nodes);

  /// Ends what assign() or open() begins: fibers() are there.
  /// @throws std::invalid_argument for nodes that an assembly may not have; there are none then
  void close();

  /// Joins fibers() until they are opened or assigned anew.
  void join(const std::shared_ptr<const FiberGraph>& graph) { fibers_.join(graph); }

  /// [m] No point has moved further since the nodes before these; infinity where they are new, or
  /// have other radii.
  double moved() const { return moved_; }

  const FiberAssembly& fibers() const { return fibers_; }

  /// Sorted; `begin` is the first point of each among those of fibers().
  const std::vector<FiberRun>& runs() const { return runs_; }

  /// Global ids of the first segments of fibers(), by fibre.
  const std::vector<GlobalSegment>& first_ids() const { return first_ids_; }

  /// The global id of a segment: the one of this index along this fibre of fibers().
  GlobalSegment global_id(std::uint32_t fiber, std::uint32_t segment) const {
    return {first_ids_[fiber].fiber, first_ids_[fiber].segment + segment};
  }
  std::uint32_t point_of(std::uint32_t fiber, std::uint32_t segment) const {
    return fibers_.offsets()[fiber] + segment;
  }

  /// The run that a point is in: its place among runs().
  std::size_t run_of(std::uint32_t point) const;

  /// The place among runs() of what assign() had there.
  std::size_t sorted_index(std::size_t number) const { return numbers_[number]; }

  FiberNode node(std::uint64_t point) const {
    return {fibers_.points()[point], fibers_.segment_radius(static_cast<std::uint32_t>(point))};
  }

  /// Adds segments [begin, end) of one of runs() to others.
  void add_to(FiberRuns& others, const FiberRun& run, std::uint64_t begin, std::uint64_t end) const;

  /// [m] From the start of the whole fibre to this point: the sum that one process makes.
  double arc(std::uint32_t point) const;
  /// [m] From the start of the whole fibre to point `i` of a run, from 0 to its number of segments.
  double arc(const FiberRun& run, std::uint64_t i) const;

 private:
  void clear();
  void expand_radii();

  FiberAssembly fibers_;
  std::vector<FiberRun> runs_;
  std::vector<std::uint32_t> numbers_;    // place among the sorted runs by the number it was given
  std::vector<GlobalSegment> first_ids_;  // of the first segment, by fibre

  // While nodes are placed those of fibers_, which has none then:
  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> offsets_{0};
  std::vector<double> radii_;   // one for all, or one per point
  double radius_before_ = 0.0;  // of all, infinity if they had several
  double moved_ = 0.0;
};

}  // namespace fiber
