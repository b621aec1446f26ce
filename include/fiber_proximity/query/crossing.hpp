#pragma once

#include <Eigen/Core>
#include <cstdint>
#include <tuple>

namespace fiber {

/// Where the axes of two segments cross as a viewer sees them: on one ray of sight.
struct Crossing {
  std::uint32_t fiber_a = 0;
  std::uint32_t segment_a = 0;
  double s = 0.0;  ///< curve parameter on segment a, in [0, 1]; within 2⁻³⁸ of the exact one
  std::uint32_t fiber_b = 0;
  std::uint32_t segment_b = 0;
  double t = 0.0;  ///< the same on segment b

  bool a_is_over = false;  ///< a is nearer to the viewer; exact, as is the sign
  /// As in knot theory: +1 where the strand above turns counter-clockwise, by less than half a
  /// turn, to the direction of the one below, as the viewer sees them; else −1. The same from both
  /// sides, and for both directions of both strands together.
  int sign = 0;

  double separation = 0.0;  ///< of the two axes along the ray of sight, >= 0 [m]
  /// The separation less both radii [m]: what is left between fibres that lie across the ray,
  /// negative where they cannot pass. The signed distance of the two segments is at most this.
  double gap = 0.0;
  Eigen::Vector3d point_a;  ///< on the axis of a [m]
  Eigen::Vector3d point_b;  ///< on the axis of b [m]

  /// What crossings are sorted by; a is the smaller one of the pair.
  auto key() const { return std::tie(fiber_a, segment_a, fiber_b, segment_b); }
};

}  // namespace fiber
