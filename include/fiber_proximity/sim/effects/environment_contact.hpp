#pragma once

#include <memory>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/sim/contacts.hpp"

namespace fiber {

struct ObstacleShape;

/// Contacts of rods with the objects around them, by the barrier of the distance of axes from
/// objects: from 1.05 radii on, and never nearer than 0.95 of them.
///
/// Nodes have contacts of their own, so that a rod lying flat rests on all of them; an edge has one
/// where it is nearer than its ends are, weighted by how much nearer
/// (src/sim/contact/obstacle_contact.hpp). Of meshes and octrees each triangle or cell counts.
///
/// How far a step may go rests on the convexity of distances, and for edges that come from farther
/// away on the certified time of contact with the shape.
class EnvironmentContact : public ContactSource {
 public:
  /// How stiff contacts are, and which are none.
  struct Options {
    double stiffness = 0.0;  ///< [N/m] >= 0; 0 derives it from the rod as FiberContact does
    AllowedPairs allowed;    ///< what may touch, and then is not kept apart; fibres are rods
  };

  /// @throws std::invalid_argument for a stiffness that is negative or not finite
  EnvironmentContact(std::shared_ptr<const Environment> environment, const Options& options);
  ~EnvironmentContact() override;

  /// From the next step on.
  void set_environment(std::shared_ptr<const Environment> environment);

  void find(const Rods& rods, const Room& room, ContactSet& found) override;

 private:
  void place_fibers(const Rods& rods);
  void add(const Rods& rods, const Contact& contact, double within, ContactSet& found) const;

  std::shared_ptr<const Environment> environment_;
  std::vector<std::vector<ObstacleShape>> shapes_;  // by object
  Options options_;
  // The rods with each node twice: segments of even index are nodes, the others edges.
  FiberAssembly fibers_;
  AllowedPairs allowed_;        // in segments of these
  double reach_ = -1.0;         // [m] within which the answer has everything; below 0 for none
  QueryResult result_;          // for these
  std::vector<double> needed_;  // by rod: how far what it may touch in a step is at the most [m]
  std::vector<double> moved_;   // by rod: since the answer [m]
};

}  // namespace fiber
