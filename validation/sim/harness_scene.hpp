#pragma once

#include <cstdint>

#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// How large a harness is.
struct HarnessSize {
  std::uint32_t branches = 8;
  std::uint32_t segments = 60;  ///< of the trunk and of each branch
};

/// A harness on an arm that swings to and fro: a trunk, and branches that are welded to its end.
/// Clips on the arm hold the trunk at both ends and each branch in between; every second branch
/// ends in a clip, too, and the others hang down with a rigid plug at their ends. All may touch
/// themselves, each other, the arm and the ground, with friction.
Stepper harness_on_an_arm(const HarnessSize& size, const StepperOptions& options);

}  // namespace fiber
