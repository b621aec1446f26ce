#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "benchmark/kernels/motion_kernel.hpp"
#include "benchmark/report.hpp"

namespace fiber {

/// Settings of the measurement of contact times; all counts are at least 1.
struct MotionMeasurement {
  std::vector<std::string> families;                        ///< none: all
  std::vector<double> tolerances{1e-3, 1e-6, 1e-9, 1e-12};  ///< parts of the motion's extent
  std::uint64_t seed = 1;

  /// To judge, per family and tolerance; of motions without thickness, whose truth is in rationals,
  /// a hundredth.
  std::uint32_t count = 440'000;
  std::uint32_t threads = 1;  ///< to judge with

  std::vector<std::string> kernels = motion_kernel_names();
  double tolerance = 1e-6;    ///< of those that keep none, and of the motions told apart
  std::uint32_t timed = 500;  ///< motions of a family to ask all kernels about
  std::uint32_t repeats = 11;

  std::vector<std::string> scenes{"tress_a", "soup", "cables", "cloth"};
  double scale = 0.1;                    ///< of their numbers of fibres
  std::vector<double> ways{1, 10, 100};  ///< of points from frame to frame, mean radii

  std::string known;  ///< a file of motions for read_known_motions(); none: no such rows
};

/// Our answers to motions of each family, judged.
void measure_motion_accuracy(const MotionMeasurement& what, const ReportRow& report);

/// Our answers to the known motions, judged and compared with the truth in the file.
void measure_known_motions(const MotionMeasurement& what, const ReportRow& report);

/// Decisions and times of all kernels, on the known motions as well.
void measure_motion_times(const MotionMeasurement& what, const ReportRow& report);

/// Whole scenes, one state after the other against the motion between them.
void measure_scene_motions(const MotionMeasurement& what, const ReportRow& report);

}  // namespace fiber
