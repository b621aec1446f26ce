#pragma once

#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/io/fiber_file.hpp"

namespace fiber {

/// How noisy the points of a recording are, and how far they go.
struct TrackNoise {
  /// [m] Standard deviation of a coordinate; none where it cannot be told.
  std::optional<double> noise;
  std::string reason;  ///< why it cannot be told

  /// [m] How far the fastest point goes from a frame to the next, the median over the frames; 0
  /// where no two frames have the same points.
  double step = 0.0;
};

/// Estimates the noise of points from what remains beside a smooth motion.
///
/// Noise of a standard deviation σ that is another one in each frame gives the k-th difference of a
/// coordinate over the frames the variance C(2k, k) σ². A smooth motion adds to low differences
/// more than to high ones, so the smallest estimate of the second, third and fourth differences
/// counts. The scale of the differences is taken from the median of their magnitudes, which jerks
/// of a few frames do not move. Noise that a tracker has smoothed over several frames is not seen.
///
/// Only frames in a row count whose numbers are equally far apart and whose fibres have the same
/// numbers of points.
/// @param frames in the order of time
TrackNoise estimate_noise(const std::vector<FiberFrame>& frames);

}  // namespace fiber
