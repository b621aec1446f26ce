#pragma once

namespace fiber {

/// Static rods whose length and bending stiffness are 1, by integrating the elastica's differential
/// equation in 1000 steps and shooting at what holds at its other end.

/// The free end of a rod that is clamped level at the other.
struct CantileverTip {
  double drop;
  double reach;
};

/// By Bisshopp and Drucker 1945, with a load along the rod as well.
/// @param load   point load at the tip times L²/EI
/// @param spread load along the rod times L³/EI
CantileverTip cantilever_tip(double load, double spread);

/// A rod that is bent by nature and hangs from a clamp that points down stays in its plane up to
/// this natural curvature times its length: beyond, what it weighs is lower beside the plane. There
/// the equilibrium of forces and moments, linear in the rotations out of the plane, has a solution.
/// @param weight             of the rod times L²/EI
/// @param twisting_stiffness GJ/EI
/// @throws boost::math::evaluation_error if it leaves its plane below 4, or at no curvature at
/// which
///         it has one shape in the plane only
double critical_natural_curvature(double weight, double twisting_stiffness);

/// A rod hangs from a clamp that points down and is lowered until its tip stands on the ground
/// below and it buckles. Its tip slides where the force along the ground is the friction's
/// coefficient times that across.
/// @param friction coefficient, up to 0.3: until then the tip is the rod's lowest point
/// @param weight   of the rod times L²/EI
/// @returns how much nearer to the ground than the rod's length the clamp is then, over the length
double lowering_until_tip_slides(double friction, double weight);

}  // namespace fiber
