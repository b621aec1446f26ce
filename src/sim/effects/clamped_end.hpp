#pragma once

#include "fiber_proximity/sim/effects/attachment.hpp"
#include "fiber_proximity/sim/pack_system.hpp"
#include "src/sim/pack_lane.hpp"

namespace fiber {

/// The end of a rod that a clamp holds: how the edge there is bent against the clamp, and with
/// twist how its cross-section is turned.
class ClampedEnd {
 public:
  /// @param placement must outlive this
  ClampedEnd(const PackLane& rod, std::uint32_t node, const Placement& placement);
  ClampedEnd(const Rods& rods, const Attachment::Hold& hold, const Placement& placement);

  /// With twist only: from the clamp to the cross-section of the edge [rad], by whole turns near
  /// another.
  double twist(double near) const;

  /// [J]
  /// @param near     what twist() takes
  /// @param has_bend false for rods whose natural curvature has a direction: NaturalBend is theirs
  double energy(double near, bool has_bend) const;
  void add_derivatives(double near, bool has_bend, RodSystem& system) const;

  /// With which the clamp turns the end of the rod [N m].
  Eigen::Vector3d moment(double near, bool has_bend) const;

 private:
  void set_stiffnesses(double bending, double twisting, double rest_length);
  Eigen::Vector3d bend() const { return direction_.tangent - placement_.tangent; }
  void add_bending(RodSystem& system) const;
  void add_twisting(double twist, RodSystem& system) const;

  const Placement& placement_;
  std::uint32_t edge_;  // from the rod's first one
  EdgeDirection direction_;
  double bending_ = 0.0;   // stiffness [J]
  double twisting_ = 0.0;  // the same

  // With twist:
  bool has_twist_ = false;
  double angle_ = 0.0;  // of the cross-section against the director [rad]
  Eigen::Vector3d director_;
  Eigen::Vector3d start_tangent_;
};

}  // namespace fiber
