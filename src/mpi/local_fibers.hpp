#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/mpi/fiber_runs.hpp"

namespace fiber {

/// What a rank's engine is asked about: its own segments and those of its halo. Segments that
/// follow each other are joined to one fibre here, and all are in the order of contacts, so that a
/// pair has the same first segment everywhere.
class LocalFibers {
 public:
  /// @throws std::invalid_argument for more points than an assembly may have
  void assign(const FiberRuns& own, const FiberRuns& halo);

  const FiberAssembly& fibers() const { return fibers_; }

  /// What the segment that starts at this point, of this fibre here, is called by all.
  GlobalSegment name_of(std::uint32_t fiber, std::uint32_t segment) const {
    return {first_[fiber].fiber, first_[fiber].segment + segment};
  }
  std::uint32_t point_of(std::uint32_t fiber, std::uint32_t segment) const {
    return fibers_.offsets()[fiber] + segment;
  }

  /// Whether the segment that starts at this point is this rank's own.
  bool is_own(std::uint32_t point) const { return is_own_[point] != 0; }

  /// [m] from the start of the whole fibre to this point.
  double arc(std::uint32_t point) const { return arcs_[point]; }

 private:
  FiberAssembly fibers_;
  std::vector<GlobalSegment> first_;  // by fibre
  std::vector<std::uint8_t> is_own_;  // by point
  std::vector<double> arcs_;          // by point

  // Work memory, kept from one frame to the next:
  std::vector<Eigen::Vector3d> points_;
  std::vector<double> radii_;
  std::vector<std::uint32_t> offsets_;
};

}  // namespace fiber
