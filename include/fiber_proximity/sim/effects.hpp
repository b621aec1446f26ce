#pragma once

#include <array>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "fiber_proximity/sim/time_table.hpp"

namespace fiber {

/// An effect that is computed in all lanes of a pack at once, by functions that are compiled for
/// each instruction set.
class LaneEffect : public Effect {
 public:
  void energy(const RodPack& rods, const NodeValues& values, SimdBatch& energy) const override {
    const Kernels chosen = kernels();
    chosen.energy(rods, values, chosen.constants, energy);
  }
  void add_derivatives(const RodPack& rods, const NodeValues& values,
                       PackSystem& system) const override {
    const Kernels chosen = kernels();
    chosen.add_derivatives(rods, values, chosen.constants, system);
  }

 protected:
  /// The functions of Effect, for the instruction set of this machine.
  struct Kernels {
    void (*energy)(const RodPack&, const NodeValues&, const double* constants, SimdBatch&);
    void (*add_derivatives)(const RodPack&, const NodeValues&, const double* constants,
                            PackSystem&);
    const double* constants = nullptr;  ///< of all nodes
  };

 private:
  virtual Kernels kernels() const = 0;
};

/// Resistance of edges to change their lengths: ½ EA l (|e|/l − 1)² each, with the edge e and its
/// length l at rest (Bergou et al. 2010, Sect. 4.1).
class Stretch : public LaneEffect {
 public:
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;

 private:
  Kernels kernels() const override;
};

/// Edges that keep their lengths, in place of stretch, by an augmented Lagrangian (Nocedal and
/// Wright 2006, Sect. 17.3): a stiff spring holds each edge, and where the energy is at a minimum,
/// its force becomes the edge's multiplier, the tension. That is repeated until no edge of the rod
/// is longer or shorter by more than 1e-6 of its length.
///
/// Forces add up along a hanging rod. With n edges and springs n² as stiff as the inertia of a
/// node, the relative error of lengths does not depend on n.
class Inextensible : public LaneEffect {
 public:
  explicit Inextensible(const Rods& rods);

  void begin_step(Rods& rods, const TimeStep& step) override;
  bool is_stored() const override { return false; }

  NodeData per_node_data() const override { return {&springs_.front().tension, 2}; }

  bool has_multipliers() const override { return true; }
  bool update_multipliers(const Rods& rods, std::uint32_t rod) override;
  void take_state(const Effect& other) override {
    springs_ = static_cast<const Inextensible&>(other).springs_;
  }
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;

 private:
  /// The data of an edge, see per_node_data().
  struct Spring {
    double tension = 0.0;    // [N]
    double stiffness = 0.0;  // in this step [N/m]
  };

  Kernels kernels() const override;
  double force(const Rods& rods, std::uint32_t edge) const;

  std::vector<Spring> springs_;  // of edges
};

/// Resistance of a round rod to bending: ½ EI/l (|k| − k₀)² at each inner node, with the length l
/// that belongs to the node (Bergou et al. 2008, Sect. 4.2) and the turn k = b − a from one edge's
/// tangent a to that of the next, b. |k| = 2 sin(φ/2) for the angle φ between them: unlike the
/// 2 tan(φ/2) of Bergou et al. (2008, Eq. 1) it is finite when the rod folds, and to fourth order
/// it is nearer to φ.
///
/// Rods::natural_curvatures, if there are any, give k₀. Without twist they have no direction: a
/// cross-section that may turn about the tangent without effort lets the rod bend to any side.
/// Rods::natural_curvature_vectors have one, which cross-sections carry along: the energy is then
/// that of the turn away from the natural one.
class Bend : public LaneEffect {
 public:
  void begin_step(Rods& rods, const TimeStep& step) override;
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;
  NodeData per_node_data() const override;

 private:
  Kernels kernels() const override;

  // By node, for this step; at most one of the two is not empty.
  std::vector<double> natural_turns_;                // k₀
  std::vector<Eigen::Vector2d> natural_curvatures_;  // with a direction [1/m]
};

/// An energy of how far rods are bent towards Rods::stiff_sides: ½ k (ρ − ρ₀)² at each inner node,
/// ρ = ½ (b·m − a·n) with the tangents a and b of its edges and the directions m and n across them,
/// towards the side, that their cross-sections carry along. As Bergou et al. (2008, Sect. 4.2) do
/// with their material curvatures it averages over both cross-sections. In the plane of a bend by
/// the angle φ towards the side ρ is sin φ; no rigid motion changes it.
class BendToSide : public Effect {
 public:
  NodeData per_node_data() const override;
  void energy(const RodPack& rods, const NodeValues& values, SimdBatch& energy) const override;
  void add_derivatives(const RodPack& rods, const NodeValues& values,
                       PackSystem& system) const override;
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;

 protected:
  /// By node: k, the side, ρ₀. Of this step.
  std::vector<std::array<double, 4>> values_;

 private:
  template <class Visit>
  void for_each_bend(const RodPack& rods, const NodeValues& values, const Visit& visit) const;
};

/// Resists bending towards Rods::stiff_sides, beyond the resistance of Bend, which is to be there,
/// too. ρ₀ is that of natural curvature.
class AnisotropicBend : public BendToSide {
 public:
  void begin_step(Rods& rods, const TimeStep& step) override;
};

/// Rods that stay bent: where the curvature differs from the natural one by more than the yield
/// strain allows, the natural one follows after each step (return mapping, Simo and Hughes 1998,
/// Sect. 1.4, in one dimension). Like Rods::natural_curvatures, the plastic one has no direction.
class Plasticity : public Effect {
 public:
  /// The material's law.
  struct Options {
    double yield_strain = 0.02;  ///< of the outermost fibre, where yielding begins; > 0
    double hardening = 0.0;      ///< elastic part of the curvature beyond yield, in [0, 1)
  };

  /// Adds Rods::natural_curvatures if there are none.
  /// @throws std::invalid_argument naming the value that is out of its range, or for rods with
  ///         natural curvature vectors or stiff sides
  Plasticity(Rods& rods, const Options& options);

  void end_step(Rods& rods, const TimeStep& step) override;

 private:
  Options options_;
};

/// Resistance to twist: ½ GJ/l m² at each inner node, with the twist m between the cross-sections
/// of its edges (Bergou et al. 2008, Sect. 4.2; with the time-parallel frames of Bergou et al.
/// 2010, Sect. 5). Adds an unknown angle to each edge, and keeps the members of Rods up to date
/// that exist with twist only.
class Twist : public LaneEffect {
 public:
  /// Gives the rods their frames: untwisted, and where a rod is bent, as the shortest rotations
  /// from edge to edge carry the first director.
  /// @throws std::invalid_argument naming the rod whose section does not resist twist or has no
  ///         inertia
  explicit Twist(Rods& rods);

  NodeData per_node_data() const override { return {reference_twists_.data(), 1}; }
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;

  void end_step(Rods& rods, const TimeStep& step) override;
  void take_state(const Effect& other) override {
    reference_twists_ = static_cast<const Twist&>(other).reference_twists_;
  }

 private:
  Kernels kernels() const override;

  std::vector<double> reference_twists_;  // of the directors, at nodes; may exceed a turn [rad]
};

/// Internal friction of a Kelvin–Voigt material: each stiffness resists the rate of its strain as
/// well, with a relaxation time. Strains are such that no rigid motion changes them: lengths of
/// edges and, of the turns between them,
///
/// - without twist the size, as cross-sections that do not resist twist turn about the tangent as
///   they please;
/// - with twist both components along the material directions of the cross-sections, and the twist
///   between these.
///
/// Rates are those of the time integration: of the strains that the earlier states of the step have
/// (TimeStep), not of the strains of their weighted sum.
class Damping : public LaneEffect {
 public:
  /// @param relaxation_time of stretch, bend and twist [s]
  /// @param is_beside_bend  whether Bend acts on the same rods, without natural curvature. Without
  ///                        twist the damping of a rod that straightens gives way sideways: the
  ///                        matrix has that as far as that of Bend makes up for it, and steps take
  ///                        fewer iterations
  /// @throws std::invalid_argument if the time is negative or not finite
  explicit Damping(double relaxation_time, bool is_beside_bend = false);

  double relaxation_time() const { return relaxation_time_; }  ///< [s]

  void begin_step(Rods& rods, const TimeStep& step) override;
  bool is_stored() const override { return false; }
  NodeData per_node_data() const override { return {earlier_.data(), per_node_}; }
  void add_forces(const RodPack& rods, const NodeValues& values, RodForces& forces) const override;

 private:
  Kernels kernels() const override;

  double relaxation_time_;
  bool is_beside_bend_;

  // The share of a stiffness that resists the change by a step, and the least share of that across
  // a turn.
  std::array<double, 2> constants_{};

  // By edge, or the node that it begins with, what rates are measured from: the length, and without
  // twist the size of the turn, with twist its two components, the twist, and the part of that
  // which the directors have.
  std::vector<double> earlier_;
  std::uint32_t per_node_ = 0;
};

/// Internal friction of what AnisotropicBend resists, beside Damping for the rest: the rate of ρ,
/// from the ρ₀ that the earlier states of the step have.
class AnisotropicDamping : public BendToSide {
 public:
  /// @param damping whose relaxation time it has; asked in each step, so that it may change
  explicit AnisotropicDamping(std::shared_ptr<const Damping> damping)
      : damping_(std::move(damping)) {}

  void begin_step(Rods& rods, const TimeStep& step) override;
  bool is_stored() const override { return false; }

 private:
  std::shared_ptr<const Damping> damping_;
};

/// A uniform acceleration.
class Gravity : public LaneEffect {
 public:
  /// @param acceleration [m/s²]
  /// @throws std::invalid_argument if it is not finite
  explicit Gravity(const Eigen::Vector3d& acceleration);

 protected:
  Eigen::Vector3d acceleration_;

 private:
  Kernels kernels() const override;
};

/// A uniform acceleration that changes in time. In each step it is that of the step's end.
class GravityInTime : public Gravity {
 public:
  /// @param acceleration [m/s²]
  /// @throws std::invalid_argument if an entry is not finite
  explicit GravityInTime(TimeTable<Eigen::Vector3d> acceleration);

  void begin_step(Rods& rods, const TimeStep& step) override;

 private:
  TimeTable<Eigen::Vector3d> table_;
};

/// Wind: a mean velocity and a gust that swells and ebbs as it passes. No random numbers, so that
/// the same scene gives the same motion.
struct WindField {
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();  ///< [m/s]
  Eigen::Vector3d gust = Eigen::Vector3d::Zero();  ///< amplitude [m/s]
  double gust_period = 1.0;                        ///< [s]
  double gust_length = 1.0;                        ///< along the mean velocity [m]

  Eigen::Vector3d at(const Eigen::Vector3d& point, double time) const;
};

/// Resistance of a fluid to slender rods: ½ ρ d c |w| w per length, with the diameter d and the
/// velocity w of the fluid against the rod, across and along the rod with coefficients of their own
/// (Taylor 1952). The coefficients' product with |w| is that of the step's beginning.
class Drag : public LaneEffect {
 public:
  /// The fluid, and how much rods resist its flow.
  struct Options {
    double fluid_density = 1.2;  ///< [kg/m³]
    double across = 1.2;         ///< coefficient of a cylinder in cross flow
    double along = 0.02;         ///< coefficient along the rod
    WindField wind;
  };

  /// @throws std::invalid_argument naming the value for negative or infinite ones, or a gust whose
  ///         period or length is not positive
  explicit Drag(const Options& options);

  void begin_step(Rods& rods, const TimeStep& step) override;
  bool is_stored() const override { return false; }
  NodeData per_node_data() const override { return {nodes_.front().tangent.data(), 8}; }

 private:
  /// The data of a node in a step, see per_node_data().
  struct Node {
    Eigen::Vector3d tangent;
    Eigen::Vector3d carried;  // where the wind alone would bring it [m]
    double across;            // force by distance from there [N/m]
    double along;
  };

  Kernels kernels() const override;
  Node node_at(const Rods& rods, std::uint32_t rod, std::uint32_t node, const TimeStep& step) const;

  Options options_;
  std::vector<Node> nodes_;
};

}  // namespace fiber
