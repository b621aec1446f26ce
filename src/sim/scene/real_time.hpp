// The resolution with which a scene takes half of the time there is.
#pragma once

#include <functional>
#include <vector>

#include "fiber_proximity/sim/scene/scene.hpp"

namespace fiber {

/// The accuracies for which the segments and the substeps of a scene are chosen.
struct Resolution {
  double segments = 0.0;
  double substeps = 0.0;
};

/// The coarsest resolution that real_time chooses.
constexpr Resolution coarsest_resolution{0.5, 0.5};

/// The part of the time there is that real_time aims at: the rest is for messages, and for whatever
/// else runs.
constexpr double aimed_share = 0.5;

/// The facts of a scene that real_time asks for.
struct RealTimeScene {
  /// Nodes times substeps: the time of a frame is about in proportion to it.
  std::function<double(const Resolution&)> work;

  /// The time on one core that each of the first frames takes [s], until they have taken a budget
  /// [s].
  /// @throws std::invalid_argument if the scene cannot be made with that resolution
  std::function<std::vector<double>(const Resolution&, double budget)> frame_times;

  double time_step = 0.0;  ///< [s]
};

struct RealTimeChoice {
  Resolution resolution;
  double share = 0.0;            ///< of the time there is on one core
  bool is_extrapolated = false;  ///< from a part of its frames
};

/// Chooses the finest resolution that takes about aimed_share of the time there is. It measures
/// finer and finer ones, beginning with the coarsest, for two seconds of one core in all, and what
/// the last two lead to by a power of the work. Where these are over, it goes on like that until
/// one is near enough, three times and for less than two seconds each; otherwise it takes the
/// finest that was in time.
/// @throws std::invalid_argument if the scene cannot be made with any of them
RealTimeChoice choose_for_real_time(const RealTimeScene& scene);

/// The FrameTimer of a scene without one: measures the processor time of this thread.
std::vector<double> measure_frames(const SimDescription& scene, double budget);

}  // namespace fiber
