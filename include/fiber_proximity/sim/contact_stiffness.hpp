#pragma once

#include <string>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Largest stiffness of a contact that moves a mass in a step [N/m]: beyond, nothing is gained but
/// equations that are harder to solve.
double largest_contact_stiffness(double mass, double step);

/// A contact's stiffness by that of the rod's material [N/m].
double material_contact_stiffness(const RodSection& section, double radius);

/// That of each rod.
/// @param stiffnesses overwritten
void material_contact_stiffnesses(const Rods& rods, std::vector<double>& stiffnesses);

/// @param effect named by the error
/// @throws std::invalid_argument for a stiffness [N/m] that is negative or not finite
void validate_contact_stiffness(const std::string& effect, double stiffness);

}  // namespace fiber
