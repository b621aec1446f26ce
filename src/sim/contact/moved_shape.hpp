#pragma once

#include <array>
#include <cstdint>

#include "fiber_proximity/sim/moving_obstacles.hpp"
#include "src/environment/object_path.hpp"
#include "src/sim/contact/obstacle_contact.hpp"

namespace fiber {

/// A shape of an object that moves.
struct MovingShape {
  const ObstacleMotion* motion;  ///< of the object
  Eigen::Isometry3d in_object;   ///< pose of the shape
};

/// A shape that moves in a solve, where it is in the course of that, by its progress from 0 to 1.
///
/// Its frame's origin goes in a straight line, and it turns at a constant rate. Of a solid of
/// revolution only the axis turns: a drum that turns about its axis fills the same space all the
/// time.
class MovedShape {
 public:
  /// @param source with its motion; must outlive this
  explicit MovedShape(const ObstacleShape& source);
  MovedShape(const MovedShape&) = delete;
  MovedShape& operator=(const MovedShape&) = delete;

  /// Makes it one of another solve.
  void assign(const ObstacleShape& source);

  /// Where it is.
  const ObstacleShape& now() const { return now_; }

  double progress() const { return progress_; }
  bool has_arrived() const { return progress_ == 1.0; }
  bool moves() const { return path_.moves(); }

  /// Has it stand where it is, while rods give way.
  void wait(bool waits) { waits_ = waits; }
  bool stands_still() const { return waits_ || has_arrived(); }

  void go_to(double progress);

  /// How the ends of an edge move against the shape, as if it stood still where it is now.
  struct RelativeMotion {
    std::array<Eigen::Vector3d, 2> ways;  ///< [m]
    double deviation = 0.0;  ///< [m] by which the ends may be off the straight ways at any time
  };

  /// That of a share of a step and the same share of the shape's way that is left.
  /// @param ends          of the edge [m]
  /// @param displacements of these by the whole step [m]
  RelativeMotion relative_motion(const std::array<Eigen::Vector3d, 2>& ends,
                                 const std::array<Eigen::Vector3d, 2>& displacements,
                                 double share) const;

  /// By how much a point that moves with the shape would move in the whole solve at the rate of
  /// now, and how much of that is left [m].
  Eigen::Vector3d way(const Eigen::Vector3d& point) const;
  Eigen::Vector3d way_left(const Eigen::Vector3d& point) const {
    return (1.0 - progress_) * way(point);
  }

  /// By how much the point of the object that is here has moved since the step began, when it ends.
  /// The shape must be where it starts or ends.
  Eigen::Vector3d displacement(const Eigen::Vector3d& point) const;

  /// The same since the solve began.
  Eigen::Vector3d displacement_in_solve(const Eigen::Vector3d& point) const;

  /// A vector that is fixed to the object, turned as the object has turned since the step began.
  Eigen::Vector3d turned(const Eigen::Vector3d& vector) const;

  const ObstacleMotion& motion() const { return *now_.moving->motion; }

 private:
  Eigen::Vector3d displacement_since(const Eigen::Isometry3d& pose,
                                     const Eigen::Vector3d& point) const;

  ObstacleShape now_;
  Eigen::Isometry3d first_;
  Eigen::Isometry3d last_;
  ObjectPath path_;                                 // from the first to the last
  Eigen::Vector3d turn_ = Eigen::Vector3d::Zero();  // along it, about this axis by its length [rad]
  double progress_ = 0.0;
  bool waits_ = false;
};

/// Shortens a share of a step so that the distance from a moving obstacle loses no more than a part
/// of its excess over the least one: as bounded_share() for one that stands still, for the motion
/// of both.
/// @param displacements of nodes by the whole step [m]
double bounded_share(const ObstacleContact& contact, const ObstacleDistance& distance,
                     const MovedShape& shape, const std::vector<Eigen::Vector3d>& positions,
                     const std::vector<Eigen::Vector3d>& displacements, double part, double share);

/// Shortens a share of a step so that the axis of an edge loses no more than a part of its distance
/// from a moving shape.
/// @param edge as Rods counts edges
double bounded_share(std::uint32_t edge, const MovedShape& shape,
                     const std::vector<Eigen::Vector3d>& positions,
                     const std::vector<Eigen::Vector3d>& displacements, double part, double share);

}  // namespace fiber
