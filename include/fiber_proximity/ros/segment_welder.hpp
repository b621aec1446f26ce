#pragma once

#include <Eigen/Core>

#include "fiber_proximity/ros/chain_set.hpp"

namespace fiber_proximity_ros {

/// Joins segments that come one after another into chains.
class SegmentWelder {
 public:
  /// @param tolerance largest gap between ends that are joined, as a fraction of the shorter
  ///        segment's length
  SegmentWelder(double tolerance, ChainSet& chains) : tolerance_(tolerance), chains_(chains) {}

  /// Continues the chain with this segment, turned round if need be, and meets the one before it
  /// halfway; or begins a new chain if it is too far from its end.
  /// @returns true if a new chain began
  bool add(Eigen::Vector3d from, Eigen::Vector3d to);

  /// Ends the chain; what follows begins a new one.
  void end_chain();

 private:
  std::size_t chain_size() const { return chains_.points.size() - chains_.offsets.back(); }
  void turn_first_segment_towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to);

  double tolerance_;
  ChainSet& chains_;
  double last_length_ = 0.0;
};

}  // namespace fiber_proximity_ros
