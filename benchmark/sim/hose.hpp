#pragma once

#include <Eigen/Core>
#include <vector>

#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// A hose of 1 m, level from a clamp, that is let go at time 0: what simulations of it are compared
/// by is its tip, frame by frame.
struct Hose {
  static constexpr double length = 1.0;        ///< [m]
  static constexpr double radius = 0.01;       ///< [m]
  static constexpr double gravity = 9.81;      ///< [m/s²]
  static constexpr double frame = 1.0 / 60.0;  ///< [s]

  static RodMaterial material();
  static RodSection section();

  /// Where it is in the beginning.
  static std::vector<Eigen::Vector3d> points(int segments);
};

enum class HoseMotion {
  SWINGING,  ///< without damping
  SETTLING  ///< a mass loses 6 of its speed per second: it comes to rest, which this has no part in
};

/// The settings of a simulation.
struct HoseSetting {
  int segments = 50;
  int substeps = 4;  ///< steps per frame
  double residual = StepperOptions{}.residual;
  int max_iterations = static_cast<int>(StepperOptions{}.max_iterations);
  Integrator integrator = Integrator::IMPLICIT_EULER;
};

/// The tip at the end of each frame [m], the time the simulation took [ms] of one processor, and
/// how far it went.
struct HoseRun {
  std::vector<Eigen::Vector3d> tips;
  double ms = 0.0;
  double iterations = 0.0;      ///< of a step, on the mean
  double worst_residual = 0.0;  ///< that a step has left [m/s]
};

/// By which a speed is multiplied after a step [s] of this motion.
double hose_damping(HoseMotion motion, double step);

HoseRun simulate_hose(HoseMotion motion, const HoseSetting& setting, int frames);

/// The limit of simulations where segments and steps are ever shorter: extrapolated from two
/// numbers of segments and two of substeps, by the second order of their errors (Richardson).
/// @param segments, substeps the larger of the two
/// @returns the tip frame by frame; of SETTLING, at rest in the last one
std::vector<Eigen::Vector3d> hose_reference(HoseMotion motion, int frames, int segments,
                                            int substeps);

/// Distance of tips from where they belong, as a part of the hose's length: of SWINGING the root
/// mean square over the frames, of SETTLING that of the last frame.
double hose_error(HoseMotion motion, const std::vector<Eigen::Vector3d>& tips,
                  const std::vector<Eigen::Vector3d>& reference);

}  // namespace fiber
