#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "src/sim/joint/joint_parts.hpp"
#include "src/sim/solver/line_search.hpp"
#include "src/sim/solver/pack_step.hpp"

namespace fiber {

/// Joints that lead from rod to rod: those of one cluster join no rod with one of another.
struct JointCluster {
  std::vector<std::uint32_t> places;  ///< indices of JointParts
  std::vector<std::uint32_t> welds;

  /// One of its rods, whose island all of them are in.
  std::uint32_t rod(const JointParts& parts) const {
    return parts.places[places.front()].front().rod;
  }
};

/// The clusters of joints, in the order of their first places.
/// @param rods how many there are
std::vector<JointCluster> joint_clusters(const JointParts& parts, std::uint32_t rods);

/// The part that joints have in Newton's method for some rods.
///
/// With the bands' matrix B, the derivatives J of the places' gaps and the rows A of the welds'
/// Hessians Aᵀ A, a step p for a gradient g is the minimum of gᵀ p + ½ pᵀ (B + Aᵀ A) p among those
/// with J p = 0. With G made of J and A it is p = −B⁻¹ (g + Gᵀ y), (D + G B⁻¹ Gᵀ) y = −G B⁻¹ g,
/// where D is 0 for rows of J and 1 for rows of A (Woodbury's formula, and the Schur complement of
/// the places' Lagrange multipliers; Nocedal and Wright 2006, Sect. 16.2). The matrix on the left,
/// one for each cluster, has as few rows as the joints have. So a step is exact, however many
/// joints there are, and they take neither stiff springs nor iterations.
class JointSolver {
 public:
  /// The joints of the rods that are solved for, and where these are in the packs.
  struct Problem {
    const JointParts& parts;
    const std::vector<const JointCluster*>& clusters;
    const std::vector<std::uint32_t>& islands;  ///< by rod
    const std::vector<std::uint32_t>& packs;    ///< by rod
    const std::vector<std::size_t>& places;     ///< by node: of its first unknown in all packs
    const std::vector<std::size_t>& offsets;    ///< by pack: where it begins in all packs
  };

  /// Evaluates the energies of welds where the rods are.
  void evaluate_energies(const Problem& problem, const Rods& rods);

  /// Add the energies that were evaluated last, by island [J].
  void add_energies(const Problem& problem, std::vector<EnergySum>& energies) const;
  void add_stored_energies(const Problem& problem, std::vector<double>& energies) const;

  /// Adds the gradients of welds to those of the packs, and finds their rows. The gradient by a
  /// joined node is then the force of its joint: it is kept, and replaced by the node's part, by
  /// mass, of the sum over its place, of which the residual is that of the place.
  /// @param systems by rod
  void add_derivatives(const Problem& problem, const Rods& rods,
                       const std::vector<RodSystem*>& systems);

  /// Finds the matrices of the clusters when the packs' Hessians have been factorised.
  void factorise(const Problem& problem, const std::vector<PackStep>& packs);

  /// Makes B⁻¹ r the step for the gradient −r.
  /// @param r      of all packs
  /// @param values B⁻¹ r of all packs, overwritten
  void solve(const Problem& problem, const std::vector<PackStep>& packs,
             const std::vector<SimdBatch>& r, std::vector<SimdBatch>& values);

  /// The forces on joined nodes where add_derivatives() was called last [N].
  struct NodeForce {
    std::uint32_t node;  ///< as Rods counts nodes
    Eigen::Vector3d force;
  };
  const std::vector<NodeForce>& forces() const { return forces_; }

 private:
  /// The part of a row of G in one rod: the derivative by some unknowns that follow each other.
  struct RowPart {
    std::uint32_t row;  // of its cluster
    std::uint32_t rod;
    std::size_t first;  // place of the first of these unknowns in all packs
    std::size_t count;  // of these unknowns
    std::uint32_t end;  // which of the parts that the row has, where several are in the rod
    std::array<double, 7> values;

    /// @param begin the place of the first of some values in all packs
    double product(const double* some, std::size_t begin) const;
    void add_to(double* some, std::size_t begin, double factor) const;
  };

  /// A cluster in the course of a solve.
  struct ClusterState {
    std::vector<RowPart> parts;  // by rod, then by row
    Eigen::MatrixXd matrix;
    Eigen::LDLT<Eigen::MatrixXd> factors;
    Eigen::VectorXd values;
  };

  /// Parts begin … end - 1 of a cluster: those of one row in one rod.
  struct Column {
    std::uint32_t cluster;
    std::size_t begin;
    std::size_t end;
  };

  /// Columns begin … end - 1 of a pack: those of B⁻¹ Gᵀ that a rod has.
  struct RodColumns {
    std::uint32_t rod;
    std::size_t begin;
    std::size_t end;

    std::size_t count() const { return end - begin; }
  };

  /// The columns of the rods of a pack.
  struct PackColumns {
    std::vector<RodColumns> rods;
    std::vector<Column> columns;  // by rod
  };

  std::uint32_t add_place_rows(const Problem& problem, const std::vector<PlacedNode>& place,
                               std::uint32_t row, ClusterState& state) const;
  void unite_gradients(const Problem& problem, const Rods& rods,
                       const std::vector<RodSystem*>& systems);
  void find_columns(const Problem& problem);
  void unite(const Problem& problem, std::vector<SimdBatch>& values) const;

  std::vector<EnergySum> energies_;  // by cluster
  std::vector<double> stored_;       // by cluster
  std::vector<NodeForce> forces_;
  std::vector<double> masses_;          // of joined nodes, as forces_
  std::vector<ClusterState> states_;    // by cluster
  std::vector<PackColumns> columns_;    // by pack
  std::vector<SimdBatch> right_sides_;  // of all packs
  std::vector<SimdBatch> column_;       // of all packs
};

}  // namespace fiber
