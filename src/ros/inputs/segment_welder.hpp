#pragma once

#include <Eigen/Core>
#include <cstddef>

#include "fiber_proximity/ros/conversions.hpp"

namespace fiber_proximity_ros {

/// Joins segments that come one after another into fibers. Ends with a coordinate that is not
/// finite are missing: a fibre goes on across them, with the missing points in it, unless the
/// points known on both sides are farther apart than the segments between them can reach.
class SegmentWelder {
 public:
  explicit SegmentWelder(FiberBuffer& fibers) : fibers_(fibers) {}

  /// Continues the fibre with this segment, turned round if need be, and meets the one before it
  /// halfway; or begins a new fibre, as it is, if it is too far from its end.
  /// @param tolerance largest gap between ends that are joined, as a part of the shorter segment's
  ///        length
  /// @returns true if a new fibre began
  bool add(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double tolerance);

  /// Ends the fibre; what follows begins a new one.
  void end_fiber();

  /// Segments that were turned round to be joined.
  std::size_t turned_count() const { return turned_count_; }

  /// [m] The largest gap of ends that were joined without coinciding: by more than a thousandth of
  /// the shorter segment.
  double largest_gap() const { return largest_gap_; }

 private:
  std::size_t fiber_size() const { return fibers_.points.size() - fibers_.offsets.back(); }
  bool join(Eigen::Vector3d from, Eigen::Vector3d to, double length, double reach,
            double tolerance);
  void push(const Eigen::Vector3d& point, double length);
  bool reaches(const Eigen::Vector3d& from, const Eigen::Vector3d& to, double length,
               double tolerance) const;
  bool turn_first_segment_towards(const Eigen::Vector3d& from, const Eigen::Vector3d& to,
                                  double reach);

  FiberBuffer& fibers_;
  double last_length_ = 0.0;  // nan of a segment with a missing end
  double longest_ = 0.0;      // of the fibre's segments
  std::size_t turned_count_ = 0;
  double largest_gap_ = 0.0;
};

}  // namespace fiber_proximity_ros
