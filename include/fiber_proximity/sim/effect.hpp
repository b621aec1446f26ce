#pragma once

#include <Eigen/Core>
#include <array>
#include <cassert>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// The number of rods that are moved side by side, each in a lane of wide registers: as many as the
/// widest registers have. Narrower ones take the lanes in turns, and only those in use.
constexpr std::size_t lane_count = 8;

/// One number for each lane.
struct alignas(lane_count * sizeof(double)) SimdBatch {
  std::array<double, lane_count> lanes{};

  double& operator[](std::size_t lane) { return lanes[lane]; }
  double operator[](std::size_t lane) const { return lanes[lane]; }
};

/// An effect's data of the nodes of a pack, node by node, see NodeData.
using NodeValues = std::vector<SimdBatch>;

/// An effect's data of all rods' nodes: some numbers per node, node by node.
struct NodeData {
  const double* first = nullptr;  ///< null if there are none per node
  std::uint32_t per_node = 0;
};

/// Rods with the same number of nodes. Arrays of vectors go node by node, and coordinate by
/// coordinate; an edge has the index of its first node, as in Rods.
struct RodPack {
  SimdBatch stretching_stiffness;
  SimdBatch bending_stiffness;
  SimdBatch twisting_stiffness;
  std::vector<SimdBatch> masses;        ///< of nodes [kg]
  std::vector<SimdBatch> rest_lengths;  ///< of edges [m]

  /// The inverse lengths that the stiffnesses above act on [1/m]: of edges, and of inner nodes half
  /// of both edges; twisting ones with twist only. Where a rod has sections of its own, they are
  /// those of SectionLengths.
  std::vector<SimdBatch> inverse_stretching_lengths;
  std::vector<SimdBatch> inverse_bending_lengths;
  std::vector<SimdBatch> inverse_twisting_lengths;

  std::vector<SimdBatch> positions;  ///< vectors [m]; with twist, each with the angle of its edge

  /// The edges between these positions, updated by measure_edges().
  std::vector<SimdBatch> lengths;          ///< [m] never 0, as in EdgeDirection
  std::vector<SimdBatch> inverse_lengths;  ///< [1/m]
  std::vector<SimdBatch> tangents;         ///< vectors

  /// With twist only: the vectors of Rods by edge, and the directors where the edges are now.
  std::vector<SimdBatch> start_directors;
  std::vector<SimdBatch> start_tangents;
  std::vector<SimdBatch> directors;  ///< by measure_edges()

  /// With twist only, of inner nodes, by measure_edges(): the angle from the director of one edge
  /// to that of the next, in (-pi, pi] [rad].
  std::vector<SimdBatch> director_twists;

  std::array<std::uint32_t, lane_count> rods{};         ///< by lane
  std::array<std::uint32_t, lane_count> first_nodes{};  ///< by lane, as Rods counts nodes
  std::size_t used = 0;                                 ///< lanes; the others repeat the first one
  std::size_t unknowns = 3;                             ///< of each node: 3, or 4 with twist
  std::uint32_t node_count = 0;
  bool has_sections = false;  ///< whether lengths are those of SectionLengths
};

/// The half-bandwidth of a rod's Hessian: the unknowns of a node are coupled to each other and to
/// the positions of the next two nodes.
/// @param unknowns of each node: 3, or 4 with twist
constexpr std::size_t half_bandwidth(std::size_t unknowns) { return 2 * unknowns + 2; }

/// Gradients and Hessians of the rods of a pack, side by side.
/// The unknowns are the positions of the nodes and, with twist, the angle of the edge after each:
/// (x, y, z[, angle]) node by node. Hessians are symmetric bands, column by column from the
/// diagonal down, followed by half_bandwidth() columns of zeros.
struct PackSystem {
  /// Contents are unspecified afterwards.
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

/// One rod's part of a PackSystem, for computations rod by rod. Nodes are counted from the rod's
/// first one.
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

  /// Adds to one entry, row >= column; unknowns are counted through all nodes.
  void add_hessian_entry(std::size_t row, std::size_t column, double value) {
    hessian_[place_of(row, column)] += value;
  }

  /// Entries, with unknowns counted through all nodes; column <= row <= column + half_bandwidth().
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

/// A state of the rods before a step's end, and its weight in the rates there.
struct WeightedState {
  const RodState* state = nullptr;
  double weight = 0.0;
};

/// The beginning and the length of a step [s], and the states that its rates are measured from:
/// where the step ends, the rate of a quantity q is (q − Σ wᵢ qᵢ) / length, with its values qᵢ in
/// earlier states and their weights wᵢ, which add up to 1.
struct TimeStep {
  double start;
  double length;

  /// Those without a state are none; the first one is that in which the whole step began. With none
  /// at all it is a step of implicit Euler: rates are measured from the state in which
  /// Effect::begin_step() finds the rods.
  std::array<WeightedState, 2> earlier{};

  double end() const { return start + length; }

  /// Calls function(state, weight) for each earlier state.
  /// @param now the rods as Effect::begin_step() finds them
  template <class Function>
  void for_each_earlier(const RodState& now, const Function& function) const {
    if (earlier.front().state == nullptr) {
      function(now, 1.0);
      return;
    }
    for (const WeightedState& each : earlier) {
      if (each.state != nullptr) {
        function(*each.state, each.weight);
      }
    }
  }
};

/// An effect that acts on rods, given by its energy. A scene has objects only for the effects it
/// names; others take neither time nor memory.
///
/// A step finds the minimum of the incremental potential of implicit Euler: the sum of all energies
/// and of the kinetic one. Effects without a potential, like drag, have one for the duration of a
/// step. Energies are computed for rods side by side, one in each lane of a pack.
class Effect {
 public:
  virtual ~Effect() = default;

  /// Called once before each solve, by one thread. Rods are where rates of positions and angles are
  /// measured from: the sum of the step's earlier states, by their weights. Other quantities, such
  /// as strains, are not linear in positions: an effect that needs their rates takes the weighted
  /// sum of what they are in each earlier state. Directors and their tangents are those with which
  /// the whole step began; a single transport leads from there to each of these states.
  virtual void begin_step(Rods& /*rods*/, const TimeStep& /*step*/) {}

  /// The data of each node that the energy needs, as begin_step() has found them.
  virtual NodeData per_node_data() const { return {}; }

  /// Energy of the rods where they are now [J], up to a constant of the step. The values are the
  /// per_node_data() of the pack's nodes.
  /// @param energy by lane, overwritten
  virtual void energy(const RodPack& /*rods*/, const NodeValues& /*values*/,
                      SimdBatch& energy) const {
    energy = SimdBatch{};
  }

  /// Adds the gradient of the energy by what is unknown, and a matrix near its Hessian: positive
  /// semidefinite, at least together with the matrices of effects that it knows to be there.
  virtual void add_derivatives(const RodPack& /*rods*/, const NodeValues& /*values*/,
                               PackSystem& /*system*/) const {}

  /// Whether the effect is conservative: if not, its energy of a step is lost.
  virtual bool is_stored() const { return true; }

  /// Whether the effect enforces a constraint by Lagrange multipliers.
  virtual bool has_multipliers() const { return false; }

  /// Updates the Lagrange multipliers of a rod, where its energy is at a minimum.
  /// @returns whether the constraint holds to its tolerance; otherwise the minimum is searched
  /// again
  virtual bool update_multipliers(const Rods& /*rods*/, std::uint32_t /*rod*/) { return true; }

  /// Whether the effect keeps nodes of a rod where they are told to be.
  virtual bool holds(std::uint32_t /*rod*/) const { return false; }

  /// Called once after each step, by one thread.
  virtual void end_step(Rods& /*rods*/, const TimeStep& /*step*/) {}

  /// Takes what another effect has come to in its steps, which was made alike for the same rods and
  /// has the same options.
  virtual void take_state(const Effect& /*other*/) {}

  /// Adds the effect's forces in the rods and on them where they are now.
  virtual void add_forces(const RodPack& /*rods*/, const NodeValues& /*values*/,
                          RodForces& /*forces*/) const {}
};

using Effects = std::vector<std::shared_ptr<Effect>>;

}  // namespace fiber
