#include <cmath>
#include <string>

#include "src/sim/contact/barrier.hpp"
#include "src/sim/contact/neighbours.hpp"
#include "src/sim/require.hpp"

namespace fiber {

double material_contact_stiffness(const RodSection& section, double touching) {
  constexpr double share = 1e-3;
  // A barrier around 1 m that has the stiffness 1 N/m where surfaces meet holds so much there.
  static const double unit_force = -Barrier::around(1.0, 1.0).slope(1.0);
  return share * section.stretching_stiffness / (unit_force * touching);
}

void validate_contact_stiffness(const std::string& effect, double stiffness) {
  require_not_negative(effect + ": the stiffness", stiffness, " N/m");
}

}  // namespace fiber
