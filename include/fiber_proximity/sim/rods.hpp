#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace fiber {

/// The material of a rod.
struct RodMaterial {
  double youngs_modulus = 1e7;  ///< E [Pa]
  double shear_modulus = 4e6;   ///< G [Pa]
  double density = 1000.0;      ///< [kg/m³]

  /// Part of the bending stiffness of a solid rod, in (0, 1]: strands that slide along each other
  /// bend far more easily than they stretch.
  double bending_share = 1.0;

  /// How many times as much it takes to bend towards one side (set_stiff_side()) as across that, at
  /// least 1: a flat cable. Only with twist.
  double bending_ratio = 1.0;
};

/// The material of this name, one of material_names(): orders of magnitude, for cables that have
/// not been measured.
/// @throws std::invalid_argument listing the names
RodMaterial material_preset(const std::string& name);

std::vector<std::string> material_names();

/// The stiffnesses and masses of a rod's cross-section.
struct RodSection {
  double stretching_stiffness = 0.0;  ///< EA [N]
  double bending_stiffness = 0.0;     ///< EI [N m²], the same about all axes but for the ratio
  double twisting_stiffness = 0.0;    ///< GJ [N m²]
  double mass_per_length = 0.0;       ///< ρA [kg/m]
  double inertia_per_length = 0.0;    ///< ρJ about the tangent [kg m]
  double bending_ratio = 1.0;         ///< of EI towards the stiff side, and EI; >= 1
};

/// The section of a solid, round rod.
/// @param radius [m]
/// @throws std::invalid_argument naming the value for moduli, density or radius that are not
///         positive and finite, or a bending share out of its range
RodSection solid_round_section(const RodMaterial& material, double radius);

/// A part of a rod, by the lengths at rest from the rod's first node to its ends [m].
struct RodPart {
  double from = 0.0;
  double to = 0.0;
};

/// A part of a rod with a section of its own.
struct RodSectionPart {
  RodPart part;
  RodSection section;

  /// [m] Its own, from one node to another; none: the rod's.
  std::optional<double> radius = std::nullopt;

  /// It neither bends nor twists: one edge, which its stretching stiffness alone lets give way.
  bool is_rigid = false;
};

/// Equivalents of sections along parts of rods, with stiffnesses in series: lengths of the rods'
/// own sections (Rods::sections) that would give way as much.
struct SectionLengths {
  std::vector<double> stretching;  ///< of edges [m]
  std::vector<double> bending;     ///< of nodes: half of each edge [m]
  std::vector<double> stiff;       ///< the same of bending towards the stiff side [m]
  std::vector<double> twisting;    ///< of nodes [m]
  std::vector<double> inertias;    ///< of edges' cross-sections about the tangent [kg m²]

  bool empty() const { return stretching.empty(); }
};

/// A side of a node's cross-sections towards which more is needed to bend than across it.
struct StiffSide {
  double stiffness = 0.0;  ///< that much more, against the angle from edge to edge [N m]
  Eigen::Vector2d side = Eigen::Vector2d::Zero();  ///< of unit length, by the material directions
};

/// The positions of rods, and their rates.
struct RodState {
  std::vector<Eigen::Vector3d> positions;   ///< of nodes [m]
  std::vector<Eigen::Vector3d> velocities;  ///< [m/s]

  /// With twist only, by edge.
  std::vector<double> angles;  ///< of the cross-section against the director [rad]
  std::vector<double> spins;   ///< their rates [rad/s]
};

/// Rods as a simulation moves them: chains of nodes with masses, straight edges between them.
///
/// Rod r owns the nodes offsets[r] .. offsets[r+1]-1 of all arrays, as in FiberAssembly; an edge
/// has the index of its first node. Arrays that only one effect needs are empty without that
/// effect.
struct Rods : RodState {
  /// The part that changes in a step.
  const RodState& state() const { return *this; }
  RodState& state() { return *this; }

  std::vector<std::uint32_t> offsets{0};
  std::vector<double> radii;         ///< by rod, the largest along it [m]
  std::vector<RodSection> sections;  ///< by rod

  std::vector<double> edge_radii;  ///< by edge [m]; empty where all rods are as thick all along

  /// By edge: not 0 where it is a rigid part, a sixth of whose mass it is [kg]. With half of the
  /// mass at each of its nodes, its kinetic energy is that of a uniform bar (consistent mass
  /// matrix): ½ Σ m v² − ½ c |v₁ − v₂|². Empty: no edge is rigid.
  std::vector<double> mass_couplings;

  SectionLengths section_lengths;  ///< empty where all rods are the same all along

  /// By rod: not 0 where the last node is the first one again, and Joints::close() joins the two.
  /// Empty: no rod is closed.
  std::vector<std::uint8_t> closed;

  /// By node, as FiberTopology has them: nodes of the same number are one place, that of a joint or
  /// of a closed rod's ends; negative: the node is not joined. Joints keeps them. Empty: none is.
  std::vector<std::int32_t> joints;

  std::vector<double> masses;        ///< [kg]
  std::vector<double> rest_lengths;  ///< of edges, 0 at each rod's last node [m]

  std::vector<double> natural_curvatures;  ///< of nodes [1/m]; empty: all are 0

  /// With twist only, and in place of these if not empty: how the rod bends at rest, along the
  /// material directions of its cross-sections (material curvatures of Bergou et al. 2008, Sect.
  /// 4.2), of nodes [1/m]. At an end it is against a clamp. set_natural_shape() and
  /// set_natural_arc() make them.
  std::vector<Eigen::Vector2d> natural_curvature_vectors;

  /// With twist only, of nodes: set_stiff_side() makes them. Empty: no rod has such a side.
  std::vector<StiffSide> stiff_sides;

  /// With twist only, by edge: a unit vector across the edge that follows it without turning about
  /// it, as it was when the step began, and the tangent then.
  std::vector<Eigen::Vector3d> directors;
  std::vector<Eigen::Vector3d> start_tangents;

  std::uint32_t count() const { return static_cast<std::uint32_t>(radii.size()); }
  std::uint32_t first(std::uint32_t rod) const { return offsets[rod]; }
  std::uint32_t end(std::uint32_t rod) const { return offsets[rod + 1]; }
  std::uint32_t node_count(std::uint32_t rod) const { return end(rod) - first(rod); }

  bool is_closed(std::uint32_t rod) const { return !closed.empty() && closed[rod] != 0; }

  /// The nodes of a rod without that of a closed one which is its first one again.
  std::uint32_t given_node_count(std::uint32_t rod) const {
    return node_count(rod) - (is_closed(rod) ? 1 : 0);
  }

  bool is_rigid(std::uint32_t edge) const {
    return !mass_couplings.empty() && mass_couplings[edge] != 0.0;
  }

  /// Length at rest that belongs to an inner node: half of each of its edges [m].
  double rest_length_at(std::uint32_t node) const {
    return 0.5 * (rest_lengths[node - 1] + rest_lengths[node]);
  }

  /// The part of that which may bend.
  double bending_share_at(std::uint32_t node) const {
    if (mass_couplings.empty()) {
      return 1.0;
    }
    const double before = is_rigid(node - 1) ? 0.0 : rest_lengths[node - 1];
    const double after = is_rigid(node) ? 0.0 : rest_lengths[node];
    return (before + after) / (rest_lengths[node - 1] + rest_lengths[node]);
  }

  /// Length at rest that belongs to the place where a closed rod begins and ends [m].
  double rest_length_at_seam(std::uint32_t rod) const {
    return 0.5 * (rest_lengths[end(rod) - 2] + rest_lengths[first(rod)]);
  }

  double edge_radius(std::uint32_t rod, std::uint32_t edge) const {
    return edge_radii.empty() ? radii[rod] : edge_radii[edge];
  }

  /// The larger radius of the edges that end at a node [m].
  double node_radius(std::uint32_t rod, std::uint32_t node) const;

  /// Gives the edges of rods that have no radius yet that of their rod.
  void add_edge_radii();

  /// Radii as FiberAssembly takes them, of rods or of points: those of edges are never less than
  /// they are, and more where a thick edge is alone between two thinner ones, for the edge before.
  std::vector<double> assembly_radii() const;

  /// The moment of inertia of an edge's cross-section about the tangent [kg m²]; 0 at each rod's
  /// last node.
  double section_inertia(std::uint32_t rod, std::uint32_t edge) const {
    return section_lengths.empty() ? sections[rod].inertia_per_length * rest_lengths[edge]
                                   : section_lengths.inertias[edge];
  }

  /// The stiffness of an edge against stretch [N/m].
  double edge_stiffness(std::uint32_t rod, std::uint32_t edge) const {
    return sections[rod].stretching_stiffness /
           (section_lengths.empty() ? rest_lengths[edge] : section_lengths.stretching[edge]);
  }

  /// Adds a rod that is at rest and neither stretched nor compressed.
  /// @param points [m] at least two
  /// @param radius [m]
  /// @throws std::invalid_argument naming rod, point or edge, and value, for fewer points, points
  ///         that are not finite, edges without length, a radius that is not positive, a section
  ///         that does not validate; nothing is added then
  void add(const std::vector<Eigen::Vector3d>& points, double radius, const RodSection& section);

  /// Gives parts of a rod sections of their own, with their masses; the others keep that of the
  /// rod. Call at most once for a rod.
  /// @param parts one behind the other
  /// @throws std::invalid_argument naming rod, part and value, for parts that overlap or leave the
  ///         rod, those with a radius of their own that do not go from node to node, rigid ones
  ///         that are not one edge or follow each other, and sections, that of the rod included,
  ///         whose stiffnesses and masses are not positive and finite; nothing is changed then
  void set_sections(std::uint32_t rod, const std::vector<RodSectionPart>& parts);

  /// Has a rod with twist bend towards one side as much less easily as the bending ratios of its
  /// sections say. The cross-sections take the side with them. AnisotropicBend acts by it. To be
  /// called after set_sections().
  /// @param towards to which side of its first edge; of any length
  /// @throws std::invalid_argument naming the rod, for one without twist, and for a side that
  ///         is not finite or is along the edge
  void set_stiff_side(std::uint32_t rod, const Eigen::Vector3d& towards);
};

}  // namespace fiber
