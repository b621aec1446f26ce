#pragma once

#include <string>
#include <vector>

namespace fiber {

/// What a rod is made of.
struct RodMaterial {
  double youngs_modulus = 1e7;  ///< E [Pa]
  double shear_modulus = 4e6;   ///< G [Pa]
  double density = 1000.0;      ///< [kg/m³]

  /// Of the bending stiffness that a solid rod would have, in (0, 1]: strands that slide along each
  /// other bend far more easily than they stretch.
  double bending_share = 1.0;
};

/// The material of this name: one of material_names(). Orders of magnitude, in want of a
/// measurement of the cable at hand.
/// @throws std::invalid_argument listing the names
RodMaterial material_preset(const std::string& name);

std::vector<std::string> material_names();

/// How the cross-section of a rod resists.
struct RodSection {
  double stretching_stiffness = 0.0;  ///< EA [N]
  double bending_stiffness = 0.0;     ///< EI [N m²], the same about all axes
  double twisting_stiffness = 0.0;    ///< GJ [N m²]
  double mass_per_length = 0.0;       ///< ρA [kg/m]
  double inertia_per_length = 0.0;    ///< ρJ about the tangent [kg m]
};

/// The section of a solid, round rod.
/// @param radius [m]
/// @throws std::invalid_argument naming the value for moduli, density or radius that are not
///         positive and finite, or a bending share out of its range
RodSection solid_round_section(const RodMaterial& material, double radius);

/// @throws std::invalid_argument naming the first value that is not finite, or not positive where
/// it
///         must be: stretching stiffness and mass; the others may be 0
void validate(const RodSection& section);

}  // namespace fiber
