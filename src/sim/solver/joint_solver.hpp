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
  std::vector<std::uint32_t> places;              ///< indices of JointParts
  std::vector<std::vector<std::uint32_t>> welds;  ///< by place that has some

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
/// one for each cluster, has as few rows as the joints have: A is a root of the sum of the Hessians
/// of a place's welds, with as many rows as that has rank, and not the welds' own rows, of which
/// there are as many as pairs of edges. So a step is exact, however many joints there are, and they
/// take neither stiff springs nor iterations.
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
  /// An unknown of a rod that rows of G are about.
  struct Unknown {
    std::uint32_t rod;
    std::size_t place;  // in all packs

    bool operator<(const Unknown& other) const {
      return rod < other.rod || (rod == other.rod && place < other.place);
    }
    bool operator==(const Unknown& other) const { return place == other.place; }
  };

  /// The part of a row of G in one rod: the derivative by some unknowns that follow each other.
  struct RowPart {
    std::uint32_t row;  // of its cluster
    std::uint32_t rod;
    std::size_t place;        // of the first of these unknowns in all packs
    std::size_t count;        // of these unknowns
    std::size_t derivative;   // the first of these, of the cluster's
    std::size_t unknown = 0;  // the first of these, of the cluster's
  };

  /// The welds of one place: their Hessian by the unknowns of their edges, and its root.
  struct WeldGroup {
    std::vector<Unknown> unknowns;
    Eigen::MatrixXd hessian;
    Eigen::MatrixXd root;  // the products of its first columns add up to it
    Eigen::Index rank;
  };

  /// A rod of a cluster: its parts and its unknowns.
  struct RodPart {
    std::uint32_t rod;
    std::uint32_t cluster;
    std::size_t first_part;
    std::size_t end_part;
    std::size_t first_unknown;
    std::size_t end_unknown;
    std::size_t response;  // the first value of its part of responses_

    std::size_t unknown_count() const { return end_unknown - first_unknown; }
  };

  /// A cluster in the course of a solve.
  struct ClusterState {
    std::vector<Unknown> unknowns;  // by rod
    std::vector<RowPart> parts;     // by rod, then by row
    std::vector<double> derivatives;
    std::vector<WeldGroup> groups;
    Eigen::MatrixXd matrix;
    Eigen::LDLT<Eigen::MatrixXd> factors;
    Eigen::VectorXd values;

    /// @param some values of all packs
    double product(const RowPart& part, const double* some) const;
    void add_to(const RowPart& part, double factor, double* some) const;
  };

  static std::uint32_t add_place_rows(const Problem& problem, const std::vector<PlacedNode>& place,
                                      std::uint32_t row, ClusterState& state);
  static void add_welds(const Problem& problem, const Rods& rods,
                        const std::vector<RodSystem*>& systems,
                        const std::vector<std::uint32_t>& welds, WeldGroup& group);
  static std::uint32_t add_weld_rows(const WeldGroup& group, std::uint32_t row,
                                     ClusterState& state);
  static void sort_parts(ClusterState& state);
  void unite_gradients(const Problem& problem, const Rods& rods,
                       const std::vector<RodSystem*>& systems);
  void find_rods(const Problem& problem);
  void add_response(const RodPart& rod);
  Eigen::Map<Eigen::MatrixXd> response_of(const RodPart& rod) {
    const auto count = static_cast<Eigen::Index>(rod.unknown_count());
    return {&responses_[rod.response], count, count};
  }
  void unite(const Problem& problem, std::vector<SimdBatch>& values) const;

  std::vector<EnergySum> energies_;  // by cluster
  std::vector<double> stored_;       // by cluster
  std::vector<NodeForce> forces_;
  std::vector<double> masses_;              // of joined nodes, as forces_
  std::vector<ClusterState> states_;        // by cluster
  std::vector<std::vector<RodPart>> rods_;  // by pack
  std::vector<SimdBatch> right_sides_;      // of all packs
  std::vector<SimdBatch> column_;           // of a pack
  std::vector<double> responses_;           // of rods' unknowns to forces on them: of B⁻¹
  std::vector<double> by_row_;              // buffer of add_response()
};

}  // namespace fiber
