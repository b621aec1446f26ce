#pragma once

#include <cstdint>

#include "fiber_proximity/sim/rods.hpp"
#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// The errors of segments and steps. `sim_validation_test --gtest_filter=Resolution.*` measures
/// them and compares them with these numbers.
struct ResolutionTable {
  /// A cantilever's tip under loads that bend it by up to 80°, in parts of how far it sinks: this
  /// / segments².
  static constexpr double bending = 1.4;

  /// The length of a polygon in a curve that turns by an angle in all, relative: this (angle /
  /// segments)².
  static constexpr double turning = 1.0 / 24.0;

  /// Implicit Euler takes of a swing's height in each period: this · step / period. It is 2 π².
  static constexpr double euler = 19.7392088;

  /// BDF2 adds to a period: this (step / period)². It is (2 π)² / 3.
  static constexpr double bdf2 = 13.1594725;
};

/// Fewest segments of a fibre so that its shape is as accurate as that.
/// @param accuracy relative, in (0, 0.5]
/// @param turning  of the fibre in all as it is at rest [rad], >= 0
/// @throws std::invalid_argument naming the value for one that is not allowed
std::uint32_t segments_for(double accuracy, double turning);

/// Fewest steps in a frame so that a swing of this period loses no more of its height in a period
/// (implicit Euler), or takes no longer (BDF2).
/// @param accuracy relative, in (0, 0.5]
/// @param frame, period [s], > 0
/// @throws std::invalid_argument naming the value for one that is not allowed
std::uint32_t substeps_for(double accuracy, Integrator integrator, double frame, double period);

/// Period of the slowest swing of a fibre that hangs from one end: of a chain by its weight, and of
/// a cantilever by its stiffness, both at once (Dunkerley) [s]; infinite if neither is there.
/// @param length  [m], > 0
/// @param gravity [m/s²], >= 0
double swing_period(const RodSection& section, double length, double gravity);

}  // namespace fiber
