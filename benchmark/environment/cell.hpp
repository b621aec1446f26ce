#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/environment/world.hpp"
#include "fiber_proximity/geometry/fiber_assembly.hpp"

namespace fiber {

/// How large the cell is.
struct CellSize {
  std::uint32_t cables = 10;
  std::uint32_t points = 100;      ///< of each cable, at least 2
  std::uint32_t triangles = 5000;  ///< of each of the eight links, about
  double frames_per_sway = 45.0;   ///< of the cables; the arm's period is 4/3 of that
};

/// A robot of eight links at a table, twenty solids on it and around it, and cables that lie there
/// in waves, across each other. The arm reaches into them and moves; the cables sway. The same bits
/// on every machine.
class Cell {
 public:
  explicit Cell(const CellSize& size);

  /// The links and the solids, a shape each, as they are in frame 0.
  const std::vector<EnvironmentObject>& objects() const { return objects_; }

  /// Where the links are in a frame.
  std::vector<ObjectChange> moves(std::uint32_t frame) const;

  /// The points of the cables in a frame [m].
  std::vector<Eigen::Vector3d> points(std::uint32_t frame) const;

  FiberAssembly cables(std::uint32_t frame) const;

 private:
  CellSize size_;
  std::vector<EnvironmentObject> objects_;  // the links first
};

/// One of many cables that might be laid there: 1.5 m long, anywhere about the table, in a wave.
FiberAssembly candidate_cable(std::uint32_t points, std::uint64_t seed);

}  // namespace fiber
