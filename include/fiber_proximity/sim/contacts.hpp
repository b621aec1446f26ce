#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/environment/environment.hpp"
#include "fiber_proximity/query/engine.hpp"
#include "fiber_proximity/sim/rods.hpp"

namespace fiber {

/// Coulomb friction in contacts, as a potential of one step (Li et al. 2020, Sect. 5): with normal
/// forces and contact planes that follow those of the step (Larionov et al. 2023), and smooth about
/// sticking. With the largest force f and the slip e that the stick speed brings in a step, the
/// force is f (2 y/e − y²/e²) for slips y below e, and f above. A slip below e is elastic: it is
/// kept from step to step, so that what rests by friction does not creep (Cundall and Strack 1979).
///
/// Without the effect Twist, slips are those of the axes and friction acts on them, as on rods that
/// cannot turn about themselves: they slide, and never roll. With Twist, slips are those of the
/// surfaces, by the motion of axes and cross-sections, and friction acts there: rods roll.
class Friction {
 public:
  /// The smoothed law of Coulomb.
  struct Options {
    double coefficient = 0.3;    ///< of friction; >= 0
    double stick_speed = 0.001;  ///< [m/s] over a step it is the length by which what sticks gives
                                 ///< way before it slides; > 0
  };

  /// @throws std::invalid_argument naming the value that is out of its range
  explicit Friction(const Options& options);

  double coefficient() const { return options_.coefficient; }

  /// @param step [s]
  /// @returns the slip below which a contact sticks [m]
  double stick_length(double step) const { return options_.stick_speed * step; }

  /// The law at a slip, per newton of the largest force; all lengths in [m].
  struct Law {
    double energy;      ///< [m]
    double resistance;  ///< force divided by the slip [1/m]
    double curvature;   ///< of the energy along the slip, never below 0 [1/m]
  };
  static Law law(double slip, double stick_length);

 private:
  Options options_;
};

class ContactSet;
struct TravelBound;

/// A contact effect: it finds the contacts that rods may have in a step.
class ContactSource {
 public:
  virtual ~ContactSource() = default;

  /// Finds all contacts that rods may reach in a step.
  /// @param rods  where they are when it begins
  /// @param bound how far they may go
  /// @param found appended to
  virtual void find(const Rods& rods, const TravelBound& bound, ContactSet& found) = 0;
};

class ObstacleMotions;

/// All contact effects of a simulation, and the friction in their contacts.
class Contacts {
 public:
  /// @param friction null for none
  /// @param motions  of the obstacles that move; null where none may come
  Contacts(std::vector<std::unique_ptr<ContactSource>> sources, std::shared_ptr<Friction> friction,
           std::shared_ptr<ObstacleMotions> motions = nullptr)
      : sources_(std::move(sources)),
        friction_(std::move(friction)),
        motions_(std::move(motions)) {}

  const std::vector<std::unique_ptr<ContactSource>>& sources() const { return sources_; }
  const Friction* friction() const { return friction_.get(); }

  /// Null while there are no obstacles that move.
  ObstacleMotions* motions() const;

  /// Null where none may come.
  ObstacleMotions* possible_motions() const { return motions_.get(); }

 private:
  std::vector<std::unique_ptr<ContactSource>> sources_;
  std::shared_ptr<Friction> friction_;
  std::shared_ptr<ObstacleMotions> motions_;
};

struct EdgePair;
class ContactNeighbours;

/// A cable that falls on a table from 1 m rises 4 cm.
constexpr double default_restitution = 0.2;

/// Contacts of rods with themselves, with each other, or both, by the potential of
/// src/sim/contact/edge_contact.hpp: from 1.05 of the sum of radii between axes on, and never
/// nearer than 0.95 of it.
///
/// Candidates come from run_tree, with a reach that serves for some steps.
class FiberContact : public ContactSource {
 public:
  /// The stiffness of contacts, and which pairs of rods have them.
  struct Options {
    Pairing pairing = Pairing::ALL;

    /// Force by distance where surfaces meet [N/m] >= 0; 0 derives it from how the rods resist
    /// stretch.
    double stiffness = 0.0;

    /// The part of the speed of their approach with which surfaces part after an impact (Newton's
    /// law of impact), in [0, 1].
    double restitution = default_restitution;
  };

  /// @throws std::invalid_argument for a stiffness that is negative or not finite, or a restitution
  ///         outside [0, 1]
  explicit FiberContact(const Options& options);
  ~FiberContact() override;

  void find(const Rods& rods, const TravelBound& bound, ContactSet& found) override;

 private:
  void find_candidates(const Rods& rods, double reach);
  void add_near(const Rods& rods, const TravelBound& bound, double approach, ContactSet& found);
  EdgePair candidate(const Rods& rods, const Contact& contact) const;
  bool owns_node(const Rods& rods, const EdgePair& pair, std::uint32_t end) const;

  Options options_;
  std::unique_ptr<ProximityEngine> engine_;
  FiberAssembly fibers_;  // where the rods were when candidates were looked for
  double reach_ = -1.0;   // [m] surfaces further apart then are no candidates
  std::unique_ptr<ContactNeighbours> neighbours_;
  std::vector<EdgePair> candidates_;
  std::vector<double> candidate_distances_;  // of axes, when they were looked for [m]
  QueryResult result_;
  std::vector<Eigen::Vector3d> ways_;  // buffer: of nodes since candidates were looked for [m]
};

struct ObstacleShape;

/// Contacts of rods with the objects around them, by the barrier of the distance of axes from
/// objects: from 1.05 radii on, and never nearer than 0.95 of them.
///
/// Nodes have contacts of their own, so that a rod lying flat rests on all of them; an edge has one
/// where it is nearer than its ends are, weighted by how much nearer
/// (src/sim/contact/obstacle_contact.hpp). Each triangle of a mesh and each cell of an octree has
/// contacts.
///
/// Steps are bounded by the convexity of distances, and for edges that come from farther away by
/// the certified time of contact with the shape.
class EnvironmentContact : public ContactSource {
 public:
  /// The stiffness of contacts, and which pairs have none.
  struct Options {
    double stiffness = 0.0;  ///< [N/m] >= 0; 0 derives it from the rod as FiberContact does
    AllowedPairs allowed;    ///< pairs that may overlap and have no contacts; fibres are rods
    double restitution = default_restitution;  ///< of impacts, in [0, 1], as FiberContact has it
  };

  /// @throws std::invalid_argument for a stiffness that is negative or not finite, or a restitution
  ///         outside [0, 1]
  EnvironmentContact(std::shared_ptr<const Environment> environment, const Options& options);
  ~EnvironmentContact() override;

  void find(const Rods& rods, const TravelBound& bound, ContactSet& found) override;

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
  std::vector<double> needed_;  // by rod: the distance within which it may reach contacts [m]
  std::vector<double> moved_;   // by rod: since the answer [m]
};

}  // namespace fiber
