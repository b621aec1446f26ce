#pragma once

#include <algorithm>
#include <array>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/effect.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/contact/contact_terms.hpp"
#include "src/sim/contact/edge_contact.hpp"
#include "src/sim/contact/friction_anchors.hpp"
#include "src/sim/contact/impact.hpp"
#include "src/sim/contact/moved_shapes.hpp"
#include "src/sim/contact/obstacle_contact.hpp"
#include "src/sim/solver/line_search.hpp"

namespace fiber {

/// An edge and an obstacle that it may reach. Where it is when looked for counts for those that
/// stand still only.
struct ObstacleEdge {
  std::uint32_t rod;
  std::uint32_t edge;  ///< as Rods counts edges
  const ObstacleShape* shape;
  double distance;                        ///< of the edge's axis when it was looked for [m]
  Eigen::Vector3d point;                  ///< of the obstacle, nearest to the edge then [m]
  Eigen::Vector3d normal;                 ///< from there to the edge, a unit vector
  std::array<Eigen::Vector3d, 2> starts;  ///< where the ends of the edge were then [m]
};

/// Where slips are measured from in a step.
struct FrictionOrigins {
  const RodState* state = nullptr;           ///< of the rods when the step began
  const FrictionAnchors* anchors = nullptr;  ///< the slips there were then
};

/// The contacts that some rods may have in a step: their potential, and that of friction in them.
class ContactSet {
 public:
  std::vector<EdgePair> pairs;
  std::vector<ObstacleContact> obstacle_contacts;
  std::vector<ObstacleEdge> obstacle_edges;

  void clear();

  /// Calls function(rod) for all that may touch something; often, for some.
  template <class Function>
  void for_each_rod(const Function& function) const {
    for (const EdgePair& pair : pairs) {
      function(pair.rod_a);
      function(pair.rod_b);
    }
    for (const ObstacleContact& contact : obstacle_contacts) {
      function(contact.rod);
    }
    for (const ObstacleEdge& edge : obstacle_edges) {
      function(edge.rod);
    }
  }

  /// Begins a solve in which obstacles may move: to be called before begin().
  /// @param islands by rod
  /// @param count   of islands
  void begin_motion(const std::vector<std::uint32_t>& islands, std::size_t count) {
    if (moved_.use_count() != 1) {
      moved_ = std::make_shared<MovedShapes>();
    }
    moved_->assign(obstacle_contacts, obstacle_edges, islands, count);
    has_motion_ = true;
  }

  /// Null without begin_motion().
  MovedShapes* moved_shapes() const { return has_motion_ ? moved_.get() : nullptr; }

  bool is_empty() const {
    return pairs.empty() && obstacle_contacts.empty() && obstacle_edges.empty();
  }

  /// Begins a step where the rods are: contacts that press there have friction, by the forces with
  /// which they press.
  /// @param friction null for none; must outlive the step
  /// @param origins  of slips: where the rods were when the anchors were found, and what slip
  ///                 there was already; must outlive the step
  /// @param step     [s]
  void begin(const Rods& rods, const Friction* friction, const FrictionOrigins& origins,
             double step);

  /// Brings the friction of some islands nearer to that of the normal forces where the rods are
  /// now, whose distances have been found, and updates its energies.
  /// @param islands by rod
  /// @param shares  by island: of the way from the forces before to those of now, in (0, 1]; 0 for
  ///                islands that stay as they are
  void update_friction(const Rods& rods, const std::vector<std::uint32_t>& islands,
                       const std::vector<double>& shares);

  /// Adds the work that the contacts of each island have done in the step beyond the energy that
  /// they have given back.
  ///
  /// In a step of implicit Euler a contact presses along its normal at the end of the step. Where
  /// its sides have slid round each other, that points along their way, and pushes them on: over a
  /// slip s at the distance d, a force p does the work p s² / 2d too much.
  /// @param islands by rod
  void add_excess_work(const Rods& rods, const std::vector<std::uint32_t>& islands,
                       std::vector<double>& work) const;

  /// Adds the energies of the slips at which contacts with friction are, where others are more than
  /// 0 [J].
  /// @param islands by rod
  void add_slip_energies(const Rods& rods, const std::vector<std::uint32_t>& islands,
                         std::vector<double>& energies) const;

  /// Has the contacts of some islands press along their normals in the middle of the way, which
  /// have no excess work: a force that resists the motion turns that along the normal at the end.
  /// Replaces what it was turned by before. Not where the sides have come round from the other
  /// side: there is no such middle.
  /// @param which by island
  /// @param count by island: of the points that have such a force
  void use_midpoint_normals(const Rods& rods, const std::vector<std::uint32_t>& islands,
                            const std::vector<bool>& which, std::vector<std::uint32_t>& count);

  /// Adds the slips at which the contacts with friction end the step.
  /// @param rods where they are then
  void add_anchors(const Rods& rods, FrictionAnchors& anchors) const;

  /// Finds the impacts of the step where it ends: if contacts press there that were not near when
  /// it began, and whose sides approached each other then faster than Impact::min_speed, or that
  /// are of a rod which may return something, those and all others that press.
  /// @param rods         with the velocities with which the step began
  /// @param is_returning by rod: whether the step before was of an impact of its, or took something
  ///                     back after one
  std::vector<Impact> find_impacts(const Rods& rods, const std::vector<bool>& is_returning) const;

  /// Keeps impacts, for add_forces(): their impulses are forces over the step.
  void add_impacts(const std::vector<Impact>& impacts) {
    impacts_.insert(impacts_.end(), impacts.begin(), impacts.end());
  }

  /// Updates the distances to where the rods are now. The functions below use these.
  void update_distances(const Rods& rods);

  /// Adds the work that moving obstacles have done in the solve by the forces at the current
  /// distances, to that of the island of its rod [J].
  /// @param islands by rod
  void add_obstacle_work(const Rods& rods, const std::vector<std::uint32_t>& islands,
                         std::vector<double>& work) const;

  /// Makes each at least the longest way that is left to an obstacle that rods of the island may
  /// reach [m].
  void add_longest_ways(const Rods& rods, const std::vector<std::uint32_t>& islands,
                        std::vector<double>& ways) const;

  /// The derivatives of contacts' energies at the current distances along what is left of the ways
  /// of obstacles [J].
  struct MotionEnergy {
    double slope = 0.0;
    double square = 0.0;  ///< the second one
    double mixed = 0.0;   ///< that along the displacements of rods, too, with the other sign
  };

  /// Adds them to those of the islands of their rods.
  void add_motion_energies(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
                           const std::vector<std::uint32_t>& islands,
                           std::vector<MotionEnergy>& energies) const;

  /// The work along the ways of obstacles against the pressure of contacts, in front of them or
  /// behind [J], and the most that it may be.
  struct Resistance {
    double now = 0.0;
    double most = 0.0;
  };

  /// Adds them to those of the islands of their rods.
  void add_resistances(const Rods& rods, const std::vector<std::uint32_t>& islands,
                       std::vector<Resistance>& resistances) const;

  /// Evaluates the energy of each contact at the current distances.
  void evaluate_energies(const Rods& rods) { evaluate_energies(rods, 0); }

  /// Adds the energy of each contact, as it was evaluated last, to that of the island of its rod.
  /// @param islands by rod
  void add_energies(const std::vector<std::uint32_t>& islands,
                    std::vector<EnergySum>& energies) const;

  /// The sum of the energies that were evaluated last, without friction [J].
  double stored_energy() const;

  /// Adds the same to the sum of each contact's island [J].
  void add_stored_energies(const std::vector<std::uint32_t>& islands,
                           std::vector<double>& energies) const;

  /// Finds the derivatives at the current distances.
  void find_derivatives(const Rods& rods);

  /// Valid until friction is updated.
  const ContactTerms& terms() const { return terms_; }

  /// Shortens each island's share of a step: no distance may lose more than four fifths of its
  /// excess over the least one, anywhere on the way. Proven, by the kernel of continuous detection.
  /// @param displacements of nodes by the whole step [m]
  /// @param islands       by rod
  /// @param shares        by island
  /// @param ends          buffer for a position of each node
  void bound_step(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
                  const std::vector<std::uint32_t>& islands, std::vector<double>& shares,
                  std::vector<Eigen::Vector3d>& ends) const;

  /// Appends the forces of the contacts at the current distances.
  void add_forces(const Rods& rods, std::vector<RodForces::ContactForce>& forces) const;

  /// Adds what the rods exert on obstacles that move.
  /// @param forces of these objects, in order; with the points that moments are about
  void add_obstacle_forces(const Rods& rods, std::vector<RodForces::ObstacleForce>& forces) const;

 private:
  /// A contact with a normal force, and what resists its slip: friction, or what turns that force
  /// to the normal in the middle of the way.
  struct ResistedPoint {
    std::size_t contact;
    ContactPoints points;
    Eigen::Vector3d normal;               // zero: it resists all motion, not slip alone
    double max_force;                     // of friction [N]
    Eigen::Vector3d reference;            // from the point of b to that of a, where slip is nil [m]
    std::optional<SurfaceLevers> levers;  // from the axes to where it acts; none: on the axes
    double viscosity = 0.0;               // of what is no friction [N/m]

    Eigen::Vector3d slip(const Rods& rods) const;

    /// The part of its energy that is given back: the slid part is lost [J].
    double stored_energy(double slip, double stick_length) const {
      return law(std::min(slip, stick_length), stick_length).energy;
    }

    /// In [J], [N/m] and [N/m].
    Friction::Law law(double slip, double stick_length) const;

    /// On a [N].
    Eigen::Vector3d force(const Rods& rods, double stick_length) const;
  };

  void relax_initial_overlap(const Rods& rods);
  template <class ShareOf>
  void add_friction(const Rods& rods, const ShareOf& share_of);
  template <class Function>
  void for_each_excess_work(const Rods& rods, const Function& function) const;
  double restitution_of(std::size_t contact) const;
  Eigen::Vector3d obstacle_velocity(const Rods& rods, const ContactPoints& points) const;
  void add_terms_of_motion(const Rods& rods);
  template <class Function>
  void for_each_term_of_motion(const Rods& rods, const Function& function) const;
  template <class Function>
  void for_each_obstacle_force(const Rods& rods, const Function& function) const;
  /// Calls function(points, term) for each term of a contact's energy.
  /// @param found buffer for the terms
  template <class Function>
  void for_each_term(const Rods& rods, std::size_t index, DistanceTerms& found,
                     const Function& function) const;
  double energy_of(const Rods& rods, std::size_t contact) const;
  void evaluate_energies(const Rods& rods, std::size_t first);
  void find_terms(const Rods& rods, std::size_t contact, DistanceTerms& found,
                  ContactDerivatives& derivatives) const;
  std::pair<std::uint32_t, std::uint32_t> rods_of(std::size_t contact) const;
  std::size_t distance_count() const { return obstacle_contacts.size() + pairs.size(); }
  std::size_t contact_count() const {
    return distance_count() + frictions_.size() + midpoint_forces_.size();
  }
  const ResistedPoint& resisted_point(std::size_t contact) const;

  std::vector<SegmentDistance> distances_;            // by pair
  std::vector<ObstacleDistance> obstacle_distances_;  // by contact
  std::vector<bool> was_near_;                        // when the step began, by contact
  std::vector<ResistedPoint> frictions_;
  std::vector<ResistedPoint> midpoint_forces_;  // turn normal forces to the middle of the way
  // The anchor that friction of a contact goes on with, by contact, once that has pressed in the
  // step. It stays that one: the points of a contact move while forces are balanced, and with
  // friction that jumps from one anchor to another they never are.
  std::vector<std::optional<const FrictionAnchors::Anchor*>> anchors_;
  std::vector<double> max_forces_before_;  // of friction, by contact [N]; buffer
  std::vector<Impact> impacts_;            // of the step
  bool has_motion_ = false;                // in this solve
  // Kept for the next solve. Those of a copy are the same, as its contacts are with them.
  std::shared_ptr<MovedShapes> moved_;
  const Friction* friction_ = nullptr;
  FrictionOrigins origins_;
  double step_ = 0.0;          // [s]
  double stick_length_ = 0.0;  // [m]
  ContactTerms terms_;
  std::vector<double> energies_;                      // by contact [J]
  std::vector<std::vector<ResistedPoint>> by_chunk_;  // buffer of add_friction()
};

template <class Function>
void ContactSet::for_each_term(const Rods& rods, std::size_t index, DistanceTerms& found,
                               const Function& function) const {
  found.clear();
  if (index < obstacle_contacts.size()) {
    const ObstacleContact& contact = obstacle_contacts[index];
    obstacle_contact(contact, obstacle_distances_[index], &found);
    for (const DistanceTerm& term : found) {
      function(ContactPoints{contact.rod, contact.edge, term.s, contact.piece.object(),
                             ContactPoints::no_edge, 0.0},
               term);
    }
    return;
  }
  const EdgePair& pair = pairs[index - obstacle_contacts.size()];
  edge_contact(pair, rods.positions, distances_[index - obstacle_contacts.size()], &found);
  for (const DistanceTerm& term : found) {
    function(ContactPoints{pair.rod_a, pair.edge_a, term.s, pair.rod_b, pair.edge_b, term.t}, term);
  }
}

}  // namespace fiber
