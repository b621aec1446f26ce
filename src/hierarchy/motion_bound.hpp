#pragma once

#include <Eigen/Core>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

#include "fiber_proximity/geometry/fiber_assembly.hpp"
#include "src/hierarchy/motion_field.hpp"
#include "src/hierarchy/motion_since_fit.hpp"

namespace fiber {

/// Remembers where fibres were, to tell how far they have moved since: each on its own, and beside
/// a field that follows all of them.
class MotionBound {
 public:
  /// Makes room for so many, which nobody touches before start().
  void reserve(std::size_t points, std::size_t fibers);

  /// From now on, motion is measured from here.
  /// @param lower, upper [m] of a box around the fibres
  void start(const FiberAssembly& fibers, const Eigen::Vector3d& lower,
             const Eigen::Vector3d& upper);

  /// Measures one fibre from here from now on, of the topology and radii of start(). There is no
  /// field until start() any more.
  void restart(const FiberAssembly& fibers, std::uint32_t fiber);

  /// Measures how far the fibres have moved, rounded up: closely enough to tell whether that leaves
  /// pairs within a margin among those within margin and skin [m]. The topology must be that of
  /// start().
  /// @return not known if radii have changed
  MotionSinceFit measure(const FiberAssembly& fibers, double skin, double margin);

  /// [m] How far each fibre has moved; null where measure() did not need to know.
  const std::vector<double>* by_fiber() const { return has_by_fiber_ ? &by_fiber_ : nullptr; }

  /// [m] Half of how far two of them that are near have moved beside each other, at most;
  /// infinite where measure() did not need to know.
  double beside_others() const { return beside_others_; }

  std::size_t memory_bytes() const;

 private:
  MotionSinceFit measure_alone(const FiberAssembly& fibers);
  MotionSinceFit beside_field(const FiberAssembly& fibers, double off) const;
  double off_field(const FiberAssembly& fibers, double sampled) const;
  double longest_segment(const FiberAssembly& fibers) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<double> radii_;
  std::vector<double> by_fiber_;
  bool has_by_fiber_ = false;
  double beside_others_ = 0.0;
  std::optional<double> longest_segment_;  // [m] found when a field first asks for it
  bool has_field_ = false;
  MotionField field_;
};

}  // namespace fiber
