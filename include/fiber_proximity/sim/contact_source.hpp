#pragma once

#include <limits>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "fiber_proximity/sim/islands.hpp"

namespace fiber {

/// Where a rod touches something: the points a on an edge of it, and b on an edge of another part
/// of the rods, or on an obstacle.
struct ContactPoint {
  static constexpr std::uint32_t obstacle = std::numeric_limits<std::uint32_t>::max();

  std::uint32_t rod_a = 0;
  std::uint32_t edge_a = 0;
  double s = 0.0;           ///< curve parameter of a on its edge, in [0, 1]
  std::uint32_t rod_b = 0;  ///< of edge_b
  std::uint32_t edge_b = obstacle;
  double t = 0.0;           ///< curve parameter of b, in [0, 1]
  Eigen::Vector3d point_b;  ///< on obstacles: b [m]
  Eigen::Vector3d normal;   ///< unit vector from b to a
  double depth = 0.0;       ///< how far the surfaces are in each other, > 0 [m]
  double stiffness = 0.0;   ///< force per depth [N/m]

  bool is_obstacle() const { return edge_b == obstacle; }
};

/// A contact effect: it knows what is near which rod, and so what they touch.
class ContactSource {
 public:
  virtual ~ContactSource() = default;

  /// Looks for what rods may meet in a step, and measures it.
  virtual void begin_step(const Rods& rods, const TimeStep& step) = 0;

  /// Measures what is how near where the rods are now; the following functions are about that.
  virtual void measure(const Rods& rods) = 0;

  /// Appends all places where rods touch something.
  virtual void find(const Rods& rods, std::vector<ContactPoint>& points) const = 0;

  /// How displacements will be gone: by all in whole, from where the step began, or by each island
  /// a share of its own, from where it is.
  enum class Way { WHOLE, SHARES };

  /// Shortens displacements of nodes so far that on straight ways from where the step began no
  /// rod's axis passes through what it may meet. Looks for more of that where displacements lead
  /// further than begin_step() could know.
  /// @param round how often it has been called for these displacements: what one source stops,
  ///              another's rods may follow into, so that each has its turn until none changes any.
  ///              From settling_round on it may do no more than has an end.
  virtual void limit(const Rods& rods, std::vector<Eigen::Vector3d>& displacements, Way way,
                     int round) = 0;
  static constexpr int settling_round = 4;

  /// Joins rods that may touch or pass through each other where they go shares of displacements,
  /// each its own.
  virtual void join(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
                    Islands& islands) = 0;
};

}  // namespace fiber
