#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"
#include "src/accuracy/setting_measurement.hpp"

namespace fiber {

/// How near fibres come to each other and to themselves in a recording.
struct FrameSurvey {
  std::size_t frames = 0;       ///< looked at
  std::vector<double> closest;  ///< [m] of each of these frames that has a pair, rising
  double largest_radius = 0.0;  ///< [m]

  /// [m] The nearest that any come.
  double minimum() const { return closest.front(); }

  /// [m] A round margin with contacts in at least half of the frames with a pair, no less than the
  /// largest radius.
  double suggested_margin() const;
};

/// Looks at all frames, or at as many, spread over all, as there is time for.
/// @param options with the neighbours that count
FrameSurvey survey_frames(const std::vector<FiberFrame>& frames, const QueryOptions& options,
                          const TimeBudget& budget);

}  // namespace fiber
