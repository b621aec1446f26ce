#pragma once

#include <memory>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/sim/contact_source.hpp"

namespace fiber {

/// Contacts of rods with the objects around them, as springs like those of FiberContact.
///
/// Once a step the environment says which points of which objects are nearest; for that step, each
/// is a plane there. Nodes have contacts of their own, so that a rod lying flat rests on all of
/// them, and edges where they are nearer than their ends. Such an edge takes over from the nodes
/// beside it what its point takes of them: the force is that of one contact wherever along the rod
/// an obstacle touches it.
///
/// No axis passes through a plane. Meshes and octrees may be on both sides of it: near them,
/// nothing moves further in a step than they are away.
class EnvironmentContact : public ContactSource {
 public:
  struct Options {
    double stiffness = 0.0;  ///< [N/m] >= 0; 0 derives it from the rod as FiberContact does
    AllowedPairs allowed;    ///< what may touch, and then is not kept apart; fibres are rods
  };

  /// @throws std::invalid_argument for a stiffness that is negative or not finite
  EnvironmentContact(std::shared_ptr<const Environment> environment, const Options& options);

  /// From the next step on.
  void set_environment(std::shared_ptr<const Environment> environment);

  void begin_step(const Rods& rods, const TimeStep& step) override;
  void measure(const Rods& rods) override;
  void find(const Rods& rods, std::vector<ContactPoint>& points) const override;
  void limit(const Rods& rods, std::vector<Eigen::Vector3d>& displacements, Way way,
             int round) override;
  void join(const Rods& /*rods*/, const std::vector<Eigen::Vector3d>& /*displacements*/,
            Islands& /*islands*/) override {}

 private:
  /// What is near a node or an edge, as a plane.
  struct Plane {
    std::uint32_t rod;
    std::uint32_t edge;
    double s;
    bool is_edge;            // or the node at this end
    bool is_convex;          // the object is all behind the plane
    double share;            // of a contact; 0 where others do better
    double stiffness;        // of a whole contact [N/m]
    Eigen::Vector3d point;   // of the object's surface [m]
    Eigen::Vector3d normal;  // out of the object
  };

  void look(const Rods& rods, double margin);
  void place_fibers(const Rods& rods);
  void share_contacts(const Rods& rods);
  std::size_t find_plane(std::size_t near, std::uint32_t segment) const;
  double stiffness_of(const Rods& rods, std::uint32_t rod, std::uint32_t edge) const;
  double free_distance(const Rods& rods, const Plane& plane) const;
  void limit_to_known(const Rods& rods, std::vector<Eigen::Vector3d>& displacements);
  void limit_to_side(const Rods& rods, const Plane& plane, std::uint32_t node,
                     Eigen::Vector3d& displacement) const;

  std::shared_ptr<const Environment> environment_;
  Options options_;
  double step_ = 0.0;          // [s]
  double longest_move_ = 0.0;  // [m] in this step
  double margin_ = 0.0;        // [m] surfaces that were further apart are not known
  // The rods with each node twice: segments of even index are nodes, the others edges.
  FiberAssembly fibers_;
  AllowedPairs allowed_;  // in segments of these
  QueryResult result_;
  std::vector<Plane> planes_;  // by contact of the result

  /// How far above a plane an axis is [m].
  struct Height {
    double nearest;  // where the plane is about
    double lowest;   // of the nodes it is about
  };
  std::vector<Height> heights_;             // by plane
  std::vector<double> material_stiffness_;  // of contacts, by rod [N/m]
};

}  // namespace fiber
