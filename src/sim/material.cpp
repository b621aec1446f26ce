#include "fiber_proximity/sim/material.hpp"

#include <cmath>

#include "src/sim/require.hpp"

namespace fiber {
RodSection solid_round_section(const RodMaterial& material, double radius) {
  require_positive("youngs_modulus", material.youngs_modulus);
  require_positive("shear_modulus", material.shear_modulus);
  require_positive("density", material.density);
  require(material.bending_share > 0.0 && material.bending_share <= 1.0, "bending_share",
          material.bending_share, "", "above 0 and at most 1");
  require_positive("radius", radius);
  const double area = M_PI * radius * radius;
  const double second_moment = area * radius * radius / 4.0;
  const double polar_moment = 2.0 * second_moment;
  return {material.youngs_modulus * area,
          material.bending_share * material.youngs_modulus * second_moment,
          material.shear_modulus * polar_moment, material.density * area,
          material.density * polar_moment};
}

void validate(const RodSection& section) {
  require_positive("stretching_stiffness", section.stretching_stiffness);
  require_not_negative("bending_stiffness", section.bending_stiffness);
  require_not_negative("twisting_stiffness", section.twisting_stiffness);
  require_positive("mass_per_length", section.mass_per_length);
  require_not_negative("inertia_per_length", section.inertia_per_length);
}

}  // namespace fiber
