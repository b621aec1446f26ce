#pragma once

#include <Eigen/Core>
#include <array>
#include <cassert>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"

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

/// So many numbers of each node of a pack, node by node.
using NodeValues = std::vector<SimdBatch>;

/// The same of all rods.
struct NodeNumbers {
  const double* first = nullptr;
  std::uint32_t per_node = 0;
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

/// How far off the diagonal a rod's Hessian has entries: what is unknown at a node meets what is
/// unknown at this node and the positions of the next two.
/// @param unknowns of each node: 3, or 4 with twist
constexpr std::size_t half_bandwidth(std::size_t unknowns) { return 2 * unknowns + 2; }

/// Gradients and Hessians of the rods of a pack, side by side.
/// Unknown are the positions of the nodes and, with twist, the angle of the edge after each:
/// (x, y, z[, angle]) node by node. Hessians are symmetric bands, column by column from the
/// diagonal down; after the last there are as many columns of zeros as a column has entries off the
/// diagonal.
struct PackSystem {
  /// What it holds then is not said.
  /// @param unknowns_per_node 3, or 4 with twist
  /// @param lanes_used        the first ones
  void resize(std::size_t node_count, std::size_t unknowns_per_node,
              std::size_t lanes_used = lane_count) {
    assert(unknowns_per_node == 3 || unknowns_per_node == 4);
    unknowns = unknowns_per_node;
    used = lanes_used;
    const std::size_t width = half_bandwidth(unknowns);
    gradient.resize(node_count * unknowns);
    hessian.resize((gradient.size() + width) * (width + 1));
  }

  void set_zero() {
    gradient.assign(gradient.size(), SimdBatch{});
    hessian.assign(hessian.size(), SimdBatch{});
  }

  std::size_t size() const { return gradient.size(); }

  std::size_t unknowns = 3;  ///< of each node
  std::size_t used = lane_count;
  std::vector<SimdBatch> gradient;
  std::vector<SimdBatch> hessian;
};

/// One rod's part of a PackSystem, for what is computed one rod after the other. Nodes are counted
/// from the rod's first one.
class RodSystem {
 public:
  /// @param system must outlive this, and not change its size
  RodSystem(PackSystem& system, std::size_t lane)
      : unknowns_(system.unknowns),
        height_(half_bandwidth(unknowns_) + 1),
        gradient_(&system.gradient[0][lane]),
        hessian_(&system.hessian[0][lane]) {}

  void add_gradient(std::uint32_t node, const Eigen::Vector3d& gradient) {
    for (std::size_t i = 0; i < 3; ++i) {
      gradient_[(node * unknowns_ + i) * lane_count] += gradient[static_cast<Eigen::Index>(i)];
    }
  }
  void add_angle_gradient(std::uint32_t edge, double gradient) {
    assert(unknowns_ == 4);
    gradient_[(edge * unknowns_ + 3) * lane_count] += gradient;
  }

  /// Adds the symmetric block of one node.
  void add_hessian(std::uint32_t node, const Eigen::Matrix3d& block) {
    const std::size_t first = node * unknowns_;
    for (int c = 0; c < 3; ++c) {
      for (int r = c; r < 3; ++r) {
        add_hessian_entry(first + r, first + c, block(r, c));
      }
    }
  }

  /// Adds the block of two nodes, row > column >= row - 2, and its transpose.
  void add_hessian(std::uint32_t row, std::uint32_t column, const Eigen::Matrix3d& block) {
    assert(row > column);
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) {
        add_hessian_entry(row * unknowns_ + r, column * unknowns_ + c, block(r, c));
      }
    }
  }

  /// Adds the derivatives of an energy of one edge: the gradient by its second node, which is minus
  /// that by its first, and so the Hessian's block.
  void add_edge(std::uint32_t edge, const Eigen::Vector3d& gradient, const Eigen::Matrix3d& block) {
    add_gradient(edge, -gradient);
    add_gradient(edge + 1, gradient);
    add_hessian(edge, block);
    add_hessian(edge + 1, block);
    add_hessian(edge + 1, edge, -block);
  }

  /// One entry, of unknowns counted through: row >= column.
  void add_hessian_entry(std::size_t row, std::size_t column, double value) {
    hessian_[place_of(row, column)] += value;
  }

  /// Of unknowns counted through, column <= row <= column + half_bandwidth().
  double gradient(std::size_t unknown) const { return gradient_[unknown * lane_count]; }
  double hessian(std::size_t row, std::size_t column) const {
    return hessian_[place_of(row, column)];
  }

  std::size_t unknowns() const { return unknowns_; }

 private:
  std::size_t place_of(std::size_t row, std::size_t column) const {
    return (column * height_ + (row - column)) * lane_count;
  }

  std::size_t unknowns_;
  std::size_t height_;  // of the band's columns
  double* gradient_;
  double* hessian_;
};

struct RodForces;

/// When a step begins, and how long it is [s].
struct TimeStep {
  double start;
  double length;

  double end() const { return start + length; }
};

/// One thing that acts on rods. A scene has objects only for the effects it names; what it does not
/// name takes neither time nor memory.
///
/// A step finds the minimum of the sum of all energies and of the kinetic one, the incremental
/// potential of implicit Euler. What has no potential, like drag, is brought into this form for the
/// duration of one step. Energies are those of rods side by side, a rod in each lane of a pack.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Called once before each solve, by one thread, with the rods where rates of the step are
  /// measured from: where it began, or for the second stage of a scheme of two where the first one
  /// points to.
  virtual void begin_step(Rods& /*rods*/, const TimeStep& /*step*/) {}

  /// What the energy needs of each node that begin_step() has found.
  virtual NodeNumbers numbers() const { return {}; }

  /// Energy of the rods where they are now [J], up to a constant of the step; of the values the
  /// effect has those numbers, node by node.
  /// @param energy by lane, overwritten
  virtual void energy(const RodPack& /*rods*/, const NodeValues& /*values*/,
                      SimdBatch& energy) const {
    energy = SimdBatch{};
  }

  /// Adds the gradient of the energy by what is unknown, and a positive semidefinite matrix near
  /// its Hessian.
  virtual void add_derivatives(const RodPack& /*rods*/, const NodeValues& /*values*/,
                               PackSystem& /*system*/) const {}

  /// Whether the energy is there again when the rods move back; if not, it only resists motion.
  virtual bool is_stored() const { return true; }

  /// Whether the effect holds a condition by forces that it has to learn.
  virtual bool has_multipliers() const { return false; }

  /// Called where a rod's energy is at a minimum. What holds a condition by a force that it has to
  /// learn (a Lagrange multiplier) learns it here.
  /// @returns whether the condition holds as well as it should; the minimum is looked for again
  ///          until it does
  virtual bool update_multipliers(const Rods& /*rods*/, std::uint32_t /*rod*/) { return true; }

  /// Called once after each step, by one thread.
  virtual void end_step(Rods& /*rods*/, const TimeStep& /*step*/) {}

  /// Adds what acts inside of the rods and on them where they are now.
  virtual void add_forces(const RodPack& /*rods*/, const NodeValues& /*values*/,
                          RodForces& /*forces*/) const {}
};

using Effects = std::vector<std::unique_ptr<Effect>>;

}  // namespace fiber
