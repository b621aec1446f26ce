#include "fiber_proximity/sim/contact_stiffness.hpp"

#include <cmath>

#include "require.hpp"

namespace fiber {

double largest_contact_stiffness(double mass, double step) {
  constexpr double largest_ratio = 1000.0;
  return largest_ratio * mass / (step * step);
}

double material_contact_stiffness(const RodSection& section, double radius) {
  const double second_moment = 0.25 * M_PI * std::pow(radius, 4);
  constexpr double share = 0.2;
  return share * section.bending_stiffness / second_moment * radius;
}

void material_contact_stiffnesses(const Rods& rods, std::vector<double>& stiffnesses) {
  stiffnesses.resize(rods.count());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    stiffnesses[rod] = material_contact_stiffness(rods.sections[rod], rods.radii[rod]);
  }
}

void validate_contact_stiffness(const std::string& effect, double stiffness) {
  require_not_negative(effect + ": the stiffness", stiffness, " N/m");
}

}  // namespace fiber
