#pragma once

#include "fiber_proximity/sim/rod_lanes.hpp"

namespace fiber {

// What a step does with all that is unknown of rods side by side; arrays of `count` Lanes.

/// Σ inertia · (position − predicted)², by lane.
Lanes weighted_squares(std::size_t count, const Lanes* inertias, const Lanes* positions,
                       const Lanes* predicted);

/// Writes factor · inertia · (position − predicted) as gradient, and factor · inertia on the
/// diagonal of a Hessian, whose columns are so high.
void set_inertia(std::size_t count, double factor, const Lanes* inertias, const Lanes* positions,
                 const Lanes* predicted, Lanes* gradient, Lanes* hessian, std::size_t height);

/// Σ a · b, by lane.
Lanes products(std::size_t count, const Lanes* a, const Lanes* b);

/// positions = from + share · step; where the share of a lane is 0, whatever the step is, from. All
/// of them may be the same.
void move_by(std::size_t count, const Lanes* from, const Lanes* step, const Lanes& shares,
             Lanes* positions);

/// What a step is, by lane.
struct StepWeight {
  Lanes decrease;  ///< −Σ gradient · step
  Lanes longest;   ///< component
};
StepWeight weigh(std::size_t count, const Lanes* gradient, const Lanes* step);

}  // namespace fiber
