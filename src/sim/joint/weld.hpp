#pragma once

#include <Eigen/Core>
#include <array>
#include <cstdint>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// An edge that ends at a place, and in which direction it is gone along.
struct WeldedEdge {
  std::uint32_t rod = 0;
  std::uint32_t edge = 0;  ///< as Rods counts edges
  std::uint32_t node = 0;  ///< that is at the place, as Rods counts nodes
  double sign = 1.0;       ///< -1: against the rod
};

/// A spring between two edges that meet at a place. Gone along from the first to the second, the
/// rod turns there by a natural angle, up to a right one where the weld was made. Its energy is
/// that of Bend or of NaturalBend, of AnisotropicBend, of Twist and of Damping at a node inside of
/// a rod.
struct Weld {
  std::array<WeldedEdge, 2> edges;
  double bending = 0.0;   ///< stiffness [J]
  double twisting = 0.0;  ///< stiffness [J]

  /// With twist: what bending takes beyond that towards a side, by the first edge's material
  /// directions.
  StiffSide stiff_side;

  /// The natural turn by its angle [rad] and side: with twist along the first edge's material
  /// directions, without as (angle, 0).
  Eigen::Vector2d natural_turn = Eigen::Vector2d::Zero();

  /// With twist: the angle by which the second edge's section is turned against the first one's
  /// where there is no twist [rad].
  double untwisted = 0.0;

  double twist = 0.0;  ///< when the step began, may exceed a turn [rad]

  /// A closed rod's seam: the natural curvature there is the rod's.
  bool is_seam = false;

  // Values of the step.
  double damping_share = 0.0;                                ///< of the stiffnesses
  Eigen::Vector4d earlier_strain = Eigen::Vector4d::Zero();  ///< that rates are measured from
};

/// Derivatives by the unknowns of an edge: its first node, with twist its angle, its second node.
/// Without twist the last column is not used.
template <int rows>
using ByEdge = Eigen::Matrix<double, rows, 7>;

/// How a weld is strained where its edges are now, and what follows from that.
class WeldStrain {
 public:
  static constexpr int max_rows = 5;

  /// @param state of the rods, whose directors are those of the step's beginning
  WeldStrain(const Weld& weld, const Rods& rods, const RodState& state);

  double energy() const { return stored_energy() + damping_energy(); }
  double stored_energy() const;

  /// Without twist the size of the turn; with twist its components along the material directions,
  /// the twist, and how much further than by nature it turns to the stiff side.
  const Eigen::Vector4d& strain() const { return strain_; }

  /// With twist: from the untwisted section [rad].
  double twist() const { return strain_[2]; }

  /// The derivative of the energy by the unknowns of the two edges, and rows A so that Aᵀ A is near
  /// its Hessian: positive semidefinite.
  struct Derivatives {
    std::array<ByEdge<1>, 2> gradient;
    std::array<ByEdge<max_rows>, 2> rows;
  };
  Derivatives derivatives() const;

  /// The moment with which the weld turns the first edge, and minus that with which it turns the
  /// second: bending and twisting together [N m].
  Eigen::Vector3d moment() const;

  /// The part of that which bends [N m].
  Eigen::Vector3d bending_moment() const;

  /// With twist: the moment with which the second edge twists the first one [N m].
  double twisting_moment() const;

 private:
  struct Section {
    Eigen::Vector3d tangent;  // signed
    double length = 0.0;
    Eigen::Vector3d first = Eigen::Vector3d::Zero();  // material directions, aligned at rest
    Eigen::Vector3d second = Eigen::Vector3d::Zero();
    ByEdge<3> by_unknowns;  // with twist: of the rotation; without: of the tangent
  };

  double damping_energy() const;
  Section section(const Rods& rods, const RodState& state, std::size_t which) const;
  void strain_with_twist();
  void strain_to_stiff_side(double cosine);
  void strain_without_twist();
  std::array<Eigen::Vector3d, 2> slopes() const;

  const Weld& weld_;
  bool has_twist_;
  std::array<Section, 2> sections_;
  Eigen::Vector4d strain_ = Eigen::Vector4d::Zero();
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();  // from the first tangent to the second

  // With twist, as in NaturalBend: the residual, and what it changes by for each section's
  // rotation, and the strains' changes by the rotation of the second against the first.
  double weight_ = 0.5;
  Eigen::Vector3d residual_ = Eigen::Vector3d::Zero();
  std::array<Eigen::Vector3d, 2> levers_;
  std::array<Eigen::Vector3d, 4> by_rotation_{};

  // Without twist.
  Eigen::Vector3d direction_ = Eigen::Vector3d::Zero();
  double natural_size_ = 0.0;
};

}  // namespace fiber
