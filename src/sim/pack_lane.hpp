#pragma once

#include <Eigen/Core>

#include "fiber_proximity/sim/edge_turn.hpp"
#include "fiber_proximity/sim/rod_pack.hpp"

namespace fiber {

/// One rod of a pack, for what is computed one rod after the other. Nodes and edges are counted
/// from the rod's first one.
class PackLane {
 public:
  PackLane(const RodPack& rods, std::size_t lane) : rods_(rods), lane_(lane) {}

  std::size_t lane() const { return lane_; }
  std::uint32_t node_count() const { return rods_.node_count; }
  bool has_twist() const { return rods_.unknowns == 4; }
  double stretching_stiffness() const { return rods_.stretching_stiffness[lane_]; }
  double bending_stiffness() const { return rods_.bending_stiffness[lane_]; }
  double twisting_stiffness() const { return rods_.twisting_stiffness[lane_]; }
  double rest_length(std::uint32_t edge) const { return rods_.rest_lengths[edge][lane_]; }
  double mass(std::uint32_t node) const { return rods_.masses[node][lane_]; }
  Eigen::Vector3d position(std::uint32_t node) const {
    return vector(rods_.positions, rods_.unknowns * node);
  }
  EdgeDirection direction(std::uint32_t edge) const {
    return {rods_.lengths[edge][lane_], vector(rods_.tangents, std::size_t{3} * edge)};
  }

  /// With twist only.
  double angle(std::uint32_t edge) const {
    return rods_.positions[std::size_t{4} * edge + 3][lane_];
  }
  Eigen::Vector3d director(std::uint32_t edge) const {
    return vector(rods_.directors, std::size_t{3} * edge);
  }
  Eigen::Vector3d start_tangent(std::uint32_t edge) const {
    return vector(rods_.start_tangents, std::size_t{3} * edge);
  }

 private:
  Eigen::Vector3d vector(const std::vector<SimdBatch>& from, std::size_t first) const {
    return {from[first][lane_], from[first + 1][lane_], from[first + 2][lane_]};
  }

  const RodPack& rods_;
  std::size_t lane_;
};

/// Calls function(rod, edge, its index in Rods) for all edges of the rods of a pack.
template <class Function>
void for_each_edge(const RodPack& rods, const Function& function) {
  for (std::size_t lane = 0; lane < rods.used; ++lane) {
    for (std::uint32_t edge = 0; edge + 1 < rods.node_count; ++edge) {
      function(PackLane(rods, lane), edge, rods.first_nodes[lane] + edge);
    }
  }
}

}  // namespace fiber
