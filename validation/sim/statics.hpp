#pragma once

#include "validation/sim/elastica.hpp"

namespace fiber {

/// The tip of a rod of length and bending stiffness 1, level from a clamp, where it comes to rest.
/// @param load   force on the tip, downwards
/// @param spread weight of the rod
CantileverTip simulated_tip(int segments, double load, double spread);

/// Over a span of 1, weight 1 per length: a sag, and what pulls at the ends level.
struct HangingChain {
  double sag;
  double pull;
};

/// @param length of the chain, > 1
HangingChain exact_catenary(double length);
HangingChain simulated_catenary(double length, int segments);

}  // namespace fiber
