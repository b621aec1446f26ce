#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/report.hpp"
#include "benchmark/sim/effect_costs.hpp"
#include "benchmark/sim/loads.hpp"
#include "benchmark/sim/validation.hpp"

namespace fiber {

/// Settings of the measurement of the simulation; all counts are at least 1, residuals above 0.
struct SimulationMeasurement {
  std::vector<std::string> validations = validation_names();    ///< what they are about
  std::vector<int> segments{10, 20, 30, 50, 100, 200, 400};     ///< of the hose
  std::vector<int> substeps{1, 2, 4, 8, 16, 32};                ///< of a frame of 1/60 s
  std::vector<double> residuals{1e-1, 1e-2, 1e-3, 1e-4, 1e-5};  ///< that a step may leave [m/s]
  std::vector<int> max_iterations{1, 2, 3, 4, 6, 8};            ///< the most of a step
  std::vector<int> xpbd_segments{20, 50};
  std::vector<int> xpbd_substeps{5, 10, 20, 50, 100, 200, 500, 1000};
  std::vector<int> xpbd_inertias{1, 10, 100};  ///< of cross-sections, times what they have
  std::uint32_t frames = 120;    ///< of the swinging hose; the settling one has twice as many
  int reference_segments = 400;  ///< of what the hose is compared with, and half as many
  int reference_substeps = 128;  ///< likewise
  std::vector<int> contact_edges{24, 48, 96, 192};  ///< of a turn of rope around a post
  std::vector<int> contact_substeps{1, 4, 16, 64};  ///< of a frame, of a rod that falls
  double min_ms = 50.0;                             ///< what is faster is measured again and again
  std::vector<int> peer_segments{10, 20, 50};       ///< of a cable beside Bullet and MuJoCo
  std::vector<int> peer_cable_segments{20};         ///< where cables touch
  std::uint32_t peer_cables = 10;                   ///< that touch
  std::uint32_t peer_repeats = 3;                   ///< of each time
  EffectScene effects;
  LoadSizes loads;
};

/// Closed forms and simulated rods of 50 segments.
void measure_validation(const SimulationMeasurement& what, const ReportRow& report);

/// Error and time of the hose by segments, substeps, residual and the most iterations.
void measure_convergence(const SimulationMeasurement& what, const ReportRow& report);

/// Error and time of what touches: a rope around a post by its edges, a rod that falls by the step.
void measure_contacts(const SimulationMeasurement& what, const ReportRow& report);

/// Error and time of the hose as a textbook's XPBD rod, by segments, substeps and inertia.
void measure_xpbd(const SimulationMeasurement& what, const ReportRow& report);

/// Cables by Bullet and MuJoCo, where they are installed, beside ours; those that are not, a line
/// each on stderr.
void measure_peers(const SimulationMeasurement& what, const ReportRow& report);

/// Time and memory of each effect on one scene.
void measure_effect_costs(const SimulationMeasurement& what, const ReportRow& report);

/// How many times faster than the clock large scenes are.
void measure_real_time(const SimulationMeasurement& what, const ReportRow& report);

}  // namespace fiber
