#pragma once

#include <Eigen/Core>

#include "fiber_proximity/ros/fiber_buffer.hpp"

namespace fiber_proximity_ros {

/// Joins segments that come one after another into chains. Ends with a coordinate that is not
/// finite are missing: a chain goes on across them, with the missing points in it, unless the
/// points known on both sides are farther apart than the segments between them can reach.
class SegmentWelder {
 public:
  /// @param tolerance largest gap between ends that are joined, as a fraction of the shorter
  ///        segment's length
  SegmentWelder(double tolerance, FiberBuffer& chains) : tolerance_(tolerance), chains_(chains) {}

  /// Continues the chain with this segment, turned round if need be, and meets the one before it
  /// halfway; or begins a new chain if it is too far from its end.
  /// @returns true if a new chain began
  bool add(Eigen::Vector3d from, Eigen::Vector3d to);

  /// Ends the chain; what follows begins a new one.
  void end_chain();

 private:
  std::size_t chain_size() const { return chains_.points.size() - chains_.offsets.back(); }
  void push(const Eigen::Vector3d& point, double length);
  bool reaches(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double length) const;
  void turn_first_segment_towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  double tolerance);

  double tolerance_;
  FiberBuffer& chains_;
  double last_length_ = 0.0;  // nan of a segment with a missing end
  double longest_ = 0.0;      // of the chain's segments
};

}  // namespace fiber_proximity_ros
