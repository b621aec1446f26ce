#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cmath>
#include <cstdint>
#include <memory>
#include <vector>

#include "fiber_proximity/export.hpp"
#include "fiber_proximity/geometry/fiber_topology.hpp"

namespace FIBER_PROXIMITY_EXPORT fiber {

/// A capped cylinder: all points within `radius` of the axis p0–p1. One segment of a fibre.
struct Capsule {
  Eigen::Vector3d p0;   ///< [m]
  Eigen::Vector3d p1;   ///< [m]
  double radius = 0.0;  ///< [m]
};

/// Two segments by the indices of their first points: within one assembly the smaller one first,
/// or one of a shape and one of the fibres.
struct PointPair {
  std::uint32_t a;
  std::uint32_t b;
};

/// Segments that follow each other, by the indices of their first points: begin … end - 1.
struct PointRange {
  std::uint32_t begin = 0;
  std::uint32_t end = 0;
};

/// Where a segment is: the fibre it belongs to and its index along that fibre, both from 0.
struct SegmentId {
  std::uint32_t fiber = 0;
  std::uint32_t segment = 0;
};

/// How the radii of an assembly are given.
enum class RadiusPer {
  ASSEMBLY,  ///< one for all fibres
  FIBER,     ///< one for each fibre
  POINT      ///< one for each point, or each segment at its first point
};

class FiberGraph;

/// Whether points that move are asked again if those of a joint meet.
enum class JointCheck {
  REQUIRED,  ///< those that were measured
  LEFT_OUT   ///< those that are computed from others, which did meet
};

/// Many fibres, each a chain of points with a radius; a graph of chains where points are joined.
///
/// Fibre f owns points offsets[f] .. offsets[f+1]-1. Consecutive points of a fibre make a segment,
/// a capped cylinder; the library addresses a segment by the index of its first point. Where the
/// radii of its two points differ, the segment counts as a capsule of the larger one, so a conical
/// fibre is enclosed, never cut.
///
/// A closed fibre is stored with its first point again behind its last one, which all that is told
/// of points here counts, except where they are called given. So the segment that starts at point p
/// always ends at point p + 1, and the closing segment is the last one of its fibre.
///
/// The data are validated once, on the way in; everything behind this class may rely on them:
/// finite coordinates of magnitude up to `max_coordinate`, radii in [0, max_coordinate], at least
/// two points per fibre.
class FiberAssembly {
 public:
  /// Largest magnitude of a coordinate or radius [m]; squares of differences stay finite below it.
  static constexpr double max_coordinate = 1e150;

  /// Rules for the values, and how an error message tells them.
  static bool is_valid_coordinate(double value) {
    return std::abs(value) <= max_coordinate;  // false for NaN
  }
  static bool is_valid_radius(double value) { return value >= 0.0 && value <= max_coordinate; }
  static constexpr const char* coordinate_rule =
      "coordinates must be finite and at most 1e150 m in magnitude";
  static constexpr const char* radius_rule = "radii must be finite, at least 0 and at most 1e150 m";

  FiberAssembly() = default;

  /// @param points  [m]
  /// @param offsets fibre count + 1 values, from 0 to the number of points
  /// @param radii   [m] one for all fibres, one per fibre, or one per point
  /// @throws std::invalid_argument naming fibre, point and value of the first violation
  FiberAssembly(std::vector<Eigen::Vector3d> points, std::vector<std::uint32_t> offsets,
                std::vector<double> radii);

  /// Fibres of which some are closed or joined.
  /// @param points  [m] as given: first points of closed fibres once
  /// @param offsets fibre count + 1 values, from 0 to the number of points given
  /// @param radii   [m] one for all fibres, one per fibre, or one per point given
  /// @throws std::invalid_argument also for a closed fibre of less than three points, and for
  ///         points of a joint that do not meet
  FiberAssembly(std::vector<Eigen::Vector3d> points, std::vector<std::uint32_t> offsets,
                std::vector<double> radii, const FiberTopology& topology);

  /// Moves the points without changing which fibre owns which, nor what is joined, and without
  /// allocating.
  /// @param points [m] as given, or as stored
  /// @throws std::invalid_argument for another number of points, a bad coordinate, a joint whose
  ///         points do not meet, or a closed fibre whose first point is repeated elsewhere; the
  ///         assembly is unchanged then
  void update_points(const std::vector<Eigen::Vector3d>& points,
                     JointCheck check = JointCheck::REQUIRED);

  /// update_points() without a copy: takes these points and leaves those it had.
  void exchange_points(std::vector<Eigen::Vector3d>& points);

  /// Joins fibres that are open so far. For engines, which see to it that what is joined meets.
  /// @param graph of these offsets, with no closed fibre
  void join(std::shared_ptr<const FiberGraph> graph);

  /// Moves all points by a pose, in place.
  /// @throws std::invalid_argument for a point that gets a bad coordinate; the assembly is
  /// unchanged
  ///         then
  void transform(const Eigen::Isometry3d& pose);

  /// Makes it other fibres, open and not joined, in the memory it has, with one radius for all, or
  /// one for each segment [m]: that of its first point. The last point of a fibre has one as well
  /// then, which must be 0.
  /// @throws std::invalid_argument as the constructor; the assembly is unchanged then
  void assign_segments(const std::vector<Eigen::Vector3d>& points,
                       const std::vector<std::uint32_t>& offsets,
                       const std::vector<double>& segment_radii);

  /// assign_segments() without a copy: takes these, leaves its points and offsets, and the memory
  /// of its radii.
  void exchange_segments(std::vector<Eigen::Vector3d>& points, std::vector<std::uint32_t>& offsets,
                         std::vector<double>& segment_radii);

  std::size_t fiber_count() const { return offsets_.size() - 1; }
  std::size_t point_count() const { return points_.size(); }
  std::size_t segment_count() const { return points_.size() - fiber_count(); }

  const std::vector<Eigen::Vector3d>& points() const { return points_; }
  const std::vector<std::uint32_t>& offsets() const { return offsets_; }

  /// Radii as they were given: one value, one per fibre, one per point, or one per segment at its
  /// first point [m]. Taken for radii of points, those of segments enclose the fibres, too.
  const std::vector<double>& radii() const { return radii_.empty() ? segment_radii_ : radii_; }

  /// How radii() are given.
  RadiusPer radius_per() const { return radius_per_; }

  /// The graph of joined points; null where none are joined. For engines.
  const std::shared_ptr<const FiberGraph>& graph() const { return graph_; }

  /// The joined points as they were given; empty where none are.
  FiberTopology topology() const;

  /// Whether the fibre's last segment ends at its first point.
  bool is_closed(std::size_t fiber) const;

  /// The points, offsets and radii that topology() is of, which make the same assembly: those that
  /// are stored, but first points of closed fibres once.
  std::vector<Eigen::Vector3d> given_points() const;
  const std::vector<std::uint32_t>& given_offsets() const;
  std::vector<double> given_radii() const;

  /// Whether both have the same fibres of the same numbers of points, closed and joined alike.
  bool has_topology_of(const FiberAssembly& other) const;

  /// Radius at a point of a fibre, as it was given [m]: its own, that of its fibre, or that of all.
  /// @param fiber the point's fibre, below fiber_count()
  /// @param point below point_count()
  double radius_at(std::size_t fiber, std::size_t point) const {
    switch (radius_per_) {
      case RadiusPer::FIBER:
        return radii_[fiber];
      case RadiusPer::POINT:
        return radii()[point];
      case RadiusPer::ASSEMBLY:
        break;
    }
    return radii_.front();
  }

  /// Radius of the segment that starts at this point [m].
  double segment_radius(std::uint32_t point) const {
    return segment_radii_.empty() ? radii_.front() : segment_radii_[point];
  }

  /// The largest radius of all segments [m]; 0 without any.
  double largest_radius() const { return largest_radius_; }

  /// The segment that starts at this point.
  Capsule capsule(std::uint32_t point) const {
    return {points_[point], points_[point + 1], segment_radius(point)};
  }

  /// Fibre and index of the segment that starts at this point; O(log fibres).
  SegmentId segment_id(std::uint32_t point) const;

 private:
  void become_segments();
  void require_joints_meet(const std::vector<Eigen::Vector3d>& points) const;

  std::vector<Eigen::Vector3d> points_;
  std::vector<std::uint32_t> offsets_{0};
  std::vector<double> radii_{0.0};  // as they were given; empty for those of segments
  RadiusPer radius_per_ = RadiusPer::ASSEMBLY;
  // By first point; empty when one radius serves all, so that the common case costs no memory.
  std::vector<double> segment_radii_;
  double largest_radius_ = 0.0;
  std::shared_ptr<const FiberGraph> graph_;  // none for chains
};

/// @throws std::invalid_argument naming the vector, its first coordinate that is not valid, and
/// what is
///         allowed
void require_coordinates(const char* name, const Eigen::Vector3d& vector);

/// Some of the fibres, with their radii, in this order; joined where they were, with no
/// joint_tolerance any more.
/// @param selection indices below the number of fibres
FiberAssembly select_fibers(const FiberAssembly& fibers,
                            const std::vector<std::uint32_t>& selection);

}  // namespace fiber
