#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "src/mpi/part_loads.hpp"
#include "src/mpi/step_costs.hpp"

namespace fiber {

/// What is predicted of a part. Numbers that grow with the fibres are no whole ones.
struct PlannedPart {
  double segments = 0.0;
  double halo_segments = 0.0;
  double halo_bytes = 0.0;  ///< that come for them in a step
  double neighbours = 0.0;
  double bytes = 0.0;       ///< that come to it in a step, at most
  double seconds = 0.0;     ///< that a step takes
  double efficiency = 0.0;  ///< of all, if all parts took as long as this one
};

/// What connects the ranks, and what goes over it.
struct Network {
  double bandwidth = 1.25e9;  ///< [byte/s] of each rank
  double latency = 20e-6;     ///< [s] of a message
  bool is_adopted = false;    ///< whether ranks bring what they hold: only halos travel then
};

/// Parts as they were counted.
std::vector<PlannedPart> plan_of(const std::vector<PartLoad>& loads);

/// How the share of halos shrinks while parts of a scene grow. Halos are what is near the surfaces
/// of parts: of n segments in d dimensions they are a x + b x² with x = n^(−1/d).
class HaloLaw {
 public:
  /// @param large      of parts that are a sample of the scene
  /// @param small      of as many parts of smaller scenes, equally dense
  /// @param dimensions in which the scene grows
  HaloLaw(const std::vector<PartLoad>& large, const std::vector<PartLoad>& small, int dimensions);

  /// Halo per segment of a part's own, on average.
  double share(double segments) const;

 private:
  double x_of(double segments) const;

  int dimensions_;
  double linear_ = 0.0;
  double quadratic_ = 0.0;
};

/// The fibres that this rank brings of a scene of so many segments: of the scene that is asked for,
/// 0, or of others that are equally dense.
using SampleScene = std::function<DistributedFibers(std::uint64_t segments, std::uint64_t number)>;

/// What parts of a scene hold, and how that goes on while it grows.
struct ScenePlan {
  std::vector<PlannedPart> parts;
  HaloLaw law;
};

/// Counts what parts of scenes of so many segments would hold, and of smaller ones. Where a part
/// begins is a matter of chance, so that of few parts several scenes are taken. Collective.
/// @param dimensions in which the scene grows
ScenePlan sample_scene(const Communicator& ranks, const SampleScene& scene, std::uint64_t segments,
                       int parts, double margin, int dimensions);

/// Makes parts larger, by segments that they have on average.
std::vector<PlannedPart> grown(std::vector<PlannedPart> parts, const HaloLaw& law, double segments);

/// Predicts bytes, seconds and efficiency.
void predict_steps(std::vector<PlannedPart>& parts, const StepCosts& costs, const Network& network);

}  // namespace fiber
