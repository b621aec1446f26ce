#pragma once

#include "src/scenes/hard_pairs.hpp"

namespace fiber {

/// Unrelated segments in a cube of 2 m.
HardPair generic_pair(Random& random);

/// Two segments of 1 m whose lines are this far apart [m] at this angle [rad, small].
HardPair crossing_pair(Random& random, double angle, double gap);

/// 0, tiny, or up to 0.1 m: all sizes alike.
double any_gap(Random& random);

HardPair scaled(const HardPair& pair, double factor);
HardPair shifted(const HardPair& pair, const Eigen::Vector3d& shift);

/// A power of ten, the same bits everywhere.
double power_of_ten(int exponent);

// Families, by what makes them hard.
void append_scales(std::vector<HardFamily>& families);
void append_angles(std::vector<HardFamily>& families);
void append_parallels(std::vector<HardFamily>& families);
void append_lengths(std::vector<HardFamily>& families);
void append_touches(std::vector<HardFamily>& families);

}  // namespace fiber
