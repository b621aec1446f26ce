#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace fiber {

/// How many rods are moved side by side, each in a lane of its own of wide registers.
constexpr std::size_t lane_count = 4;

/// The same number of each of them.
struct alignas(lane_count * sizeof(double)) Lanes {
  std::array<double, lane_count> of{};

  double& operator[](std::size_t lane) { return of[lane]; }
  double operator[](std::size_t lane) const { return of[lane]; }
};

/// Rods with the same number of nodes. Arrays of vectors go node by node, and coordinate by
/// coordinate; an edge has the index of its first node, as in Rods.
struct RodLanes {
  std::array<std::uint32_t, lane_count> rods{};  ///< which rod is in which lane
  std::size_t used = 0;                          ///< lanes; the others repeat the first one
  std::uint32_t node_count = 0;
  std::size_t unknowns = 3;  ///< of each node: 3, or 4 with twist

  Lanes stretching_stiffness;
  Lanes bending_stiffness;
  Lanes twisting_stiffness;
  std::vector<Lanes> masses;                ///< of nodes [kg]
  std::vector<Lanes> rest_lengths;          ///< of edges [m]
  std::vector<Lanes> inverse_rest_lengths;  ///< of edges [1/m]
  std::vector<Lanes> inverse_node_lengths;  ///< of inner nodes: of what belongs to them [1/m]

  std::vector<Lanes> positions;  ///< vectors [m]; with twist, each with the angle of its edge

  /// Of the edges between these positions, by measure_edges().
  std::vector<Lanes> lengths;          ///< [m] never 0, as in EdgeDirection
  std::vector<Lanes> inverse_lengths;  ///< [1/m]
  std::vector<Lanes> tangents;         ///< vectors

  /// With twist only, vectors of edges: those of Rods, and the directors where the edges are now.
  std::vector<Lanes> start_directors;
  std::vector<Lanes> start_tangents;
  std::vector<Lanes> directors;  ///< by measure_edges()

  /// With twist only, of inner nodes, by measure_edges(): the angle from the director of one edge
  /// to that of the next, in (-pi, pi] [rad].
  std::vector<Lanes> director_twists;
};

/// What rods have of edges where they are now.
void measure_edges(RodLanes& rods);

}  // namespace fiber
