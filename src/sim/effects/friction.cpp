#include "fiber_proximity/sim/effects/friction.hpp"

#include "src/sim/require.hpp"

namespace fiber {

Friction::Friction(const Options& options) : options_(options) {
  require_not_negative("friction: the coefficient", options.coefficient);
  require_positive("friction: the stick speed", options.stick_speed, " m/s");
}

Friction::Law Friction::law(double slip, double stick_length) {
  const double share = slip / stick_length;
  if (share < 1.0) {
    return {stick_length * share * share * (1.0 - share / 3.0), (2.0 - share) / stick_length,
            2.0 * (1.0 - share) / stick_length};
  }
  return {slip - stick_length / 3.0, 1.0 / slip, 0.0};
}

}  // namespace fiber
