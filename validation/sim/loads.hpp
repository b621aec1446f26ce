#pragma once

#include "validation/sim/elastica.hpp"
#include "validation/sim/statics.hpp"

namespace fiber {

/// The tip of a rod of length and bending stiffness 1, level from a clamp, whose other end a moment
/// turns: it rests as an arc of a circle.
CantileverTip exact_arc_tip(double moment);
CantileverTip simulated_arc_tip(int segments, double moment);

/// The same of a rod that is thicker from a clamp to a step: bending stiffness 4 there, 1 beyond.
/// @param step length of the thick part
CantileverTip exact_stepped_arc_tip(double moment, double step);
CantileverTip simulated_stepped_arc_tip(int segments, double moment, double step);

/// How far the tip of the stepped rod sinks under a force on it, by that force, where it is small.
double exact_stepped_compliance(double step);
double simulated_stepped_compliance(int segments, double step);

/// Over a span of 1, weight 1 per length, with a weight in it: the sag of the weight, and what
/// pulls at the ends level. Two arcs of catenaries meet in the weight (Irvine 1981, Sect. 1.2).
/// @param length of the chain, > 1
/// @param weight in parts of that of a length of 1
/// @param place  of the weight, in parts of the length
HangingChain exact_loaded_catenary(double length, double weight, double place);
HangingChain simulated_loaded_catenary(double length, double weight, double place, int segments);

/// The period of a weight at the end of an inextensible cable of 1 m that is let go at an angle
/// from the vertical, with BDF2 [s].
/// @param share of the cable's mass in the weight's
double exact_weight_pendulum_period(double angle, double share);
double simulated_weight_pendulum_period(int segments, double angle, double share, double step);

}  // namespace fiber
