#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/sim/contacts.hpp"

namespace fiber {

/// An object that moves as it is told, whatever touches it.
struct MovingObstacle {
  EnvironmentObject object;                                 ///< its own pose does not count
  std::function<Eigen::Isometry3d(double time)> placement;  ///< its pose by time [s]
};

/// The poses of an object in a solve of a step.
struct ObstacleMotion {
  Eigen::Isometry3d begin;  ///< as the step began
  Eigen::Isometry3d start;  ///< as the solve starts
  Eigen::Isometry3d end;    ///< as the solve ends
  double elapsed = 0.0;     ///< from the beginning of the step to the end of the solve [s]
};

/// An object that something stronger than fibres may give way keeps from where it should be.
struct ObstacleLag {
  std::uint32_t obstacle;  ///< index among those that move
  double distance;         ///< of its origin [m]
  double angle;            ///< [rad]
};

/// The objects that move in a simulation, and where they are.
///
/// A step brings each to where its placement has it at the step's end. Rods give way; where they
/// cannot, as between two objects that close on each other, the object stays behind, and goes on
/// from there.
class ObstacleMotions {
 public:
  /// @param first_index how objects are counted in RodForces: these follow those that stand still
  /// @throws std::invalid_argument naming the object, for shapes or a first pose that are not valid
  ObstacleMotions(std::vector<MovingObstacle> obstacles, std::uint32_t first_index);

  const std::vector<MovingObstacle>& obstacles() const { return obstacles_; }
  std::uint32_t first_index() const { return first_index_; }

  /// Where each is [m].
  const std::vector<Eigen::Isometry3d>& poses() const { return poses_; }

  /// The objects, where they are now.
  std::vector<EnvironmentObject> placed() const;

  /// The one that is furthest from where its placement has it at a time [s]; none if all are there.
  std::optional<ObstacleLag> longest_lag(double time) const;

  /// Has one go another way from the next step on.
  /// @throws std::invalid_argument if there is no such one
  void redirect(std::uint32_t obstacle, std::function<Eigen::Isometry3d(double time)> placement);

  /// Puts one somewhere, whatever is between: for one that was nowhere yet.
  /// @throws std::invalid_argument if there is no such one
  void place(std::uint32_t obstacle, const Eigen::Isometry3d& pose);

  /// Adds one behind the others, whatever is where its placement has it at a time [s].
  /// @throws std::invalid_argument as the constructor
  void add(MovingObstacle obstacle, double time);

  /// Removes one; those behind it are counted from one less then.
  /// @throws std::invalid_argument if there is no such one
  void remove(std::uint32_t obstacle);

  /// Another one whenever obstacles have come or gone.
  std::uint32_t revision() const { return revision_; }

  /// Takes where the objects of another simulation are, which are the same.
  void take_state(const ObstacleMotions& other) { poses_ = other.poses_; }

  // A step calls these in this order. Poses change with the end of a solve only.

  /// @param time at which the step begins [s]
  void begin_step(double time);

  /// Takes the objects back to where the step began.
  void restore() { poses_ = begin_; }

  /// @param time at which the solve ends [s]
  /// @throws std::invalid_argument naming the object, for a pose that is not valid
  void begin_solve(double time);

  /// Lets some objects go only a part of the way that they have in this solve.
  /// @param which by object
  void shorten(const std::vector<bool>& which, double share);

  void end_solve();

  /// By object; stays where it is.
  const std::vector<ObstacleMotion>& motions() const { return motions_; }

 private:
  void require(std::uint32_t obstacle) const;

  std::vector<MovingObstacle> obstacles_;
  std::vector<std::string> titles_;  // of these, for errors
  std::uint32_t first_index_;
  std::uint32_t revision_ = 0;
  double begin_time_ = 0.0;
  std::vector<Eigen::Isometry3d> begin_;
  std::vector<Eigen::Isometry3d> poses_;
  std::vector<ObstacleMotion> motions_;
};

class AllowedParts;
struct MovingShape;
struct ObstacleShape;

/// Contacts of rods with objects that move, by the same potential as those that stand still have
/// (EnvironmentContact).
class MovingObstacleContact : public ContactSource {
 public:
  /// @throws std::invalid_argument as EnvironmentContact
  MovingObstacleContact(std::shared_ptr<const ObstacleMotions> motions,
                        const EnvironmentContact::Options& options);
  ~MovingObstacleContact() override;

  void find(const Rods& rods, const TravelBound& bound, ContactSet& found) override;

 private:
  class Finder;
  struct RodReach;

  void take_shapes();

  std::shared_ptr<const ObstacleMotions> motions_;
  std::uint32_t revision_ = 0;  // of these, when shapes were taken
  EnvironmentContact::Options options_;
  std::unique_ptr<const AllowedParts> allowed_;  // null if no pairs are
  std::vector<MovingShape> moving_;              // all shapes of all objects
  std::vector<ObstacleShape> shapes_;            // the same, where they are when the solve starts
  std::vector<RodReach> reaches_;                // buffer: by rod
  FiberAssembly fibers_;  // doubled, if any pairs are allowed: how many segments there are counts
};

}  // namespace fiber
