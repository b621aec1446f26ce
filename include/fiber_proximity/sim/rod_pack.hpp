#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fiber {

/// How many rods are moved side by side, each in a lane of its own of wide registers: as many as
/// the widest have. Narrower ones take them in turns, and only as many as there are.
constexpr std::size_t lane_count = 8;

/// The same number of each of them.
struct alignas(lane_count * sizeof(double)) SimdBatch {
  std::array<double, lane_count> of{};

  double& operator[](std::size_t lane) { return of[lane]; }
  double operator[](std::size_t lane) const { return of[lane]; }
};

/// Rods with the same number of nodes. Arrays of vectors go node by node, and coordinate by
/// coordinate; an edge has the index of its first node, as in Rods.
struct RodPack {
  SimdBatch stretching_stiffness;
  SimdBatch bending_stiffness;
  SimdBatch twisting_stiffness;
  std::vector<SimdBatch> masses;                ///< of nodes [kg]
  std::vector<SimdBatch> rest_lengths;          ///< of edges [m]
  std::vector<SimdBatch> inverse_rest_lengths;  ///< of edges [1/m]
  std::vector<SimdBatch> inverse_node_lengths;  ///< of inner nodes: of what belongs to them [1/m]

  std::vector<SimdBatch> positions;  ///< vectors [m]; with twist, each with the angle of its edge

  /// Of the edges between these positions, by measure_edges().
  std::vector<SimdBatch> lengths;          ///< [m] never 0, as in EdgeDirection
  std::vector<SimdBatch> inverse_lengths;  ///< [1/m]
  std::vector<SimdBatch> tangents;         ///< vectors

  /// With twist only, vectors of edges: those of Rods, and the directors where the edges are now.
  std::vector<SimdBatch> start_directors;
  std::vector<SimdBatch> start_tangents;
  std::vector<SimdBatch> directors;  ///< by measure_edges()

  /// With twist only, of inner nodes, by measure_edges(): the angle from the director of one edge
  /// to that of the next, in (-pi, pi] [rad].
  std::vector<SimdBatch> director_twists;

  std::array<std::uint32_t, lane_count> rods{};         ///< which rod is in which lane
  std::array<std::uint32_t, lane_count> first_nodes{};  ///< of these, as Rods counts nodes
  std::size_t used = 0;                                 ///< lanes; the others repeat the first one
  std::size_t unknowns = 3;                             ///< of each node: 3, or 4 with twist
  std::uint32_t node_count = 0;
};

/// What rods have of edges where they are now.
void measure_edges(RodPack& rods);

}  // namespace fiber
