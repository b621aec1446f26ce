#pragma once

#include <array>

namespace fiber {

/// A ring that hangs from a point of it, of length 1 and bending stiffness 1, straight by nature.
struct HungRing {
  double drop;   ///< from that point to the lowest one
  double width;  ///< the largest, level
};

/// By the elastica of its half, whose tangents are level above and below (Love 1927, Sect. 262):
/// θ'' = H sin θ + w (½ − s) cos θ, with the level force H that closes it.
/// @param weight of the ring
HungRing exact_hung_ring(double weight);
HungRing simulated_hung_ring(double weight, int segments);

/// A truss of two light bars from supports 1 and 0.25 m to either side and 0.5 m above their joint,
/// and a rod that hangs from it: what pulls at each bar, in parts of the rod's weight.
std::array<double, 2> exact_truss();
std::array<double, 2> simulated_truss();

}  // namespace fiber
