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

  /// The place of the tip of a cable that is let go at 45° from a pin, straight and at rest, in
  /// parts of its length, for 0.6 of the period T of its slowest swing (1 s for a metre that hangs
  /// by its weight). Of n segments it is off by at most swing · limpness / n², but by no more than
  /// max_swing / n², in steps of implicit Euler by euler · step / T, in steps of BDF2 by bdf2 ·
  /// (step / T)².
  static constexpr double swing = 0.48;
  static constexpr double max_swing = 20.0;
  static constexpr double euler = 22.0;
  static constexpr double bdf2 = 900.0;

  /// In a step, gravity brings what touches at most this part of its radius further: half of the
  /// width of a contact's barrier between two such fibres.
  static constexpr double contact_travel = 0.1;
};

/// Fewest segments of a fibre so that they leave its tip within half of the accuracy in a swing
/// (ResolutionTable), and its shape at rest within the accuracy.
/// @param accuracy relative, in (0, 0.5]
/// @param turning  of the fibre in all as it is at rest [rad], >= 0
/// @param limpness of it, >= 0
/// @throws std::invalid_argument naming the value for one that is not allowed
std::uint32_t segments_for(double accuracy, double turning, double limpness);

/// How many times as long a fibre is as a piece of it that its weight bends much, (EI / w)^(1/3) of
/// the bending stiffness EI and the weight w of a length: 4 of a metre of hair, 13 of 8 mm rope.
/// Infinite without stiffness, 0 without gravity.
/// @param length  [m], > 0
/// @param gravity [m/s²], >= 0
double limpness(const RodSection& section, double length, double gravity);

/// Fewest steps in a frame so that they leave the tip of a fibre with this period within half of
/// the accuracy in a swing (ResolutionTable).
/// @param accuracy relative, in (0, 0.5]
/// @param frame, period [s], > 0
/// @throws std::invalid_argument naming the value for one that is not allowed
std::uint32_t substeps_for(double accuracy, Integrator integrator, double frame, double period);

/// The longest step for fibres in contact: gravity brings what rests no further in it than
/// ResolutionTable::contact_travel [s]; infinite without gravity.
/// @param radius  [m], > 0
/// @param gravity [m/s²], >= 0
double max_contact_step(double radius, double gravity);

/// Period of the slowest swing of a fibre that hangs from one end: of a chain by its weight, and of
/// a cantilever by its stiffness, both at once (Dunkerley) [s]; infinite if neither is there.
/// @param length  [m], > 0
/// @param gravity [m/s²], >= 0
double swing_period(const RodSection& section, double length, double gravity);

}  // namespace fiber
