#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

namespace fiber {

/// How large the scenes are whose real-time factors are measured.
struct LoadSizes {
  std::uint32_t cables = 10;  ///< in contact, with friction, on a table
  std::uint32_t cable_segments = 100;
  std::uint32_t rods = 1000;  ///< that swing without contact, from one end
  std::uint32_t rod_segments = 50;
  std::uint32_t branches = 8;  ///< of a harness on an arm that moves, with plugs and clips
  std::uint32_t branch_segments = 60;
  std::uint32_t frames = 120;       ///< of 1/60 s, to measure
  std::vector<int> substeps{1, 4};  ///< of a frame
  std::vector<int> threads{1, 0};   ///< 0 for as many as there are cores
};

/// The time that a scene takes by the clock.
struct LoadResult {
  std::string scene;
  std::uint32_t rods = 0;
  std::uint32_t segments = 0;  ///< of each
  std::uint32_t substeps = 0;
  std::uint32_t threads = 0;
  double ms_per_step = 0.0;
  double real_time_factor = 0.0;  ///< simulated time by time taken
};

/// Measures how many times faster than the clock scenes of a given size are.
void measure_loads(const LoadSizes& sizes, const std::function<void(const LoadResult&)>& report);

}  // namespace fiber
