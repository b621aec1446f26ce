#pragma once

#include "benchmark/sim/cable_run.hpp"

namespace fiber {

/// Distance of the tip from where it belongs, as a part of the length: of the hanging cable the
/// root mean square over frames of 1/60 s, of the cantilever that of the last one.
class TipTruth {
 public:
  /// The hanging cable's tip is that of our own simulation, extrapolated from ever more segments
  /// and steps; the cantilever's that of the elastica.
  /// @param segments, substeps of a frame: the most for the former
  TipTruth(const CableScene& scene, int segments, int substeps);

  double error(const CableRun& run) const;

 private:
  double length_;
  bool rests_;
  std::vector<Eigen::Vector3d> tips_;  // by frame
};

}  // namespace fiber
