#pragma once

namespace fiber {

/// The free end of a rod of length 1 and bending stiffness 1 that is clamped level at the other.
struct CantileverTip {
  double drop;
  double reach;
};

/// By the elastica (Bisshopp and Drucker 1945, with a load along the rod as well).
/// @param load   point load at the tip times L²/EI
/// @param spread load along the rod times L³/EI
CantileverTip cantilever_tip(double load, double spread);

}  // namespace fiber
