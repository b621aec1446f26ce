#pragma once

#include <array>
#include <utility>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/effect.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "src/sim/contact/edge_contact.hpp"
#include "src/sim/contact/obstacle_contact.hpp"
#include "src/sim/solver/line_search.hpp"

namespace fiber {

/// An edge and an obstacle that it may come to.
struct ObstacleEdge {
  std::uint32_t rod;
  std::uint32_t edge;  ///< as Rods counts edges
  const ObstacleShape* shape;
  double distance;                        ///< of the edge's axis when it was looked for [m]
  Eigen::Vector3d point;                  ///< of the obstacle, nearest to the edge then [m]
  Eigen::Vector3d normal;                 ///< from there to the edge, a unit vector
  std::array<Eigen::Vector3d, 2> starts;  ///< where the ends of the edge were then [m]
};

/// Points of two edges, or of one and an obstacle.
struct ContactPoints {
  static constexpr std::uint32_t no_edge = RodForces::ContactForce::obstacle;

  std::uint32_t rod_a;
  std::uint32_t edge_a;  ///< as Rods counts edges
  double s;
  std::uint32_t rod_b;   ///< the object's index, for an obstacle
  std::uint32_t edge_b;  ///< no_edge for an obstacle
  double t;

  bool is_of_rods() const { return edge_b != no_edge; }
};

/// Part of the gradient and Hessian of contacts: by the difference of two points.
struct ContactTerm {
  ContactPoints points;
  Eigen::Vector3d gradient;
  Eigen::Matrix3d hessian;
  double turning;  ///< times g gᵀ, part of the Hessian by the difference of a's ends [1/(N m)]
  double load;     ///< see add_loads(); 0 of friction
};

/// By chunk of contacts, which threads share.
using ContactTerms = std::vector<std::vector<ContactTerm>>;

/// Adds gradients to some rods, and what of the Hessian is within the nodes of one edge.
/// @param systems  by rod
/// @param packs    by rod
/// @param which    pack the rods are of
void add_derivatives(const ContactTerms& terms, const Rods& rods,
                     const std::vector<RodSystem*>& systems,
                     const std::vector<std::uint32_t>& packs, std::uint32_t which);

/// Whether there is anything else of the Hessian.
bool has_coupling(const ContactTerms& terms);

/// Adds what else there is of the Hessian's product with displacements.
/// @param places        of each node's x in these arrays; y and z are lane_count further each
/// @param displacements of all that is unknown
void add_coupling(const ContactTerms& terms, const std::vector<std::size_t>& places,
                  const SimdBatch* displacements, SimdBatch* product);

/// Of each rod, the largest load of its contacts: the force in parts of what its barrier holds
/// well.
/// @param loads by rod: raised
void add_loads(const ContactTerms& terms, std::vector<double>& loads);

/// Everything that some rods may touch in a step: the potential of their contacts and of friction
/// in them.
class ContactSet {
 public:
  std::vector<EdgePair> pairs;
  std::vector<ObstacleContact> obstacle_contacts;
  std::vector<ObstacleEdge> obstacle_edges;

  void clear();

  bool is_empty() const {
    return pairs.empty() && obstacle_contacts.empty() && obstacle_edges.empty();
  }

  /// Begins a step where the rods are: what touches there has friction in the step.
  /// @param friction   null for none
  /// @param references of nodes: slips are measured from there [m]
  /// @param step       [s]
  void begin(const Rods& rods, const Friction* friction,
             const std::vector<Eigen::Vector3d>& references, double step);

  /// Measures where the rods are now; the following functions are about that.
  void measure(const Rods& rods);

  /// Adds the energy of each contact to that of the island of its rod.
  /// @param islands by rod
  void add_energies(const Rods& rods, const std::vector<std::uint32_t>& islands,
                    std::vector<EnergySum>& energies);

  /// What has been added of them, without friction [J].
  double stored_energy() const;

  /// What more that would be if rods stiffened contacts by other factors [J].
  /// @param before factors that they have, by rod
  /// @param after  others
  double stiffening_energy(const std::vector<double>& before,
                           const std::vector<double>& after) const;

  /// Finds the derivatives where the rods are measured.
  void find_derivatives(const Rods& rods);

  const ContactTerms& terms() const { return terms_; }

  /// Shortens each island's share of a step: no distance may lose more than four fifths of what it
  /// has beyond the inner one, anywhere on the way. Proven, by the kernel of continuous detection.
  /// @param displacements of nodes by the whole step [m]
  /// @param islands       by rod
  /// @param shares        by island
  /// @param ends          room for a position of each node
  void bound_step(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
                  const std::vector<std::uint32_t>& islands, std::vector<double>& shares,
                  std::vector<Eigen::Vector3d>& ends) const;

  /// Appends what the contacts exert where the rods are measured.
  void add_forces(const Rods& rods, std::vector<RodForces::ContactForce>& forces) const;

 private:
  /// A contact that had a normal force when the step began.
  struct FrictionPoint {
    ContactPoints points;
    Eigen::Vector3d normal;
    double most;                // force [N]
    Eigen::Vector3d reference;  // from the point of b to that of a, where slips begin [m]

    Eigen::Vector3d slip(const Rods& rods) const;
  };

  void let_part(const Rods& rods);
  template <class Function>
  void visit(const Rods& rods, std::size_t index, std::vector<DistanceTerm>& found,
             const Function& function) const;
  double energy_of(const Rods& rods, std::size_t contact) const;
  void find_terms(const Rods& rods, std::size_t contact, std::vector<DistanceTerm>& found,
                  std::vector<ContactTerm>& terms) const;
  std::pair<std::uint32_t, std::uint32_t> rods_of(std::size_t contact) const;
  std::size_t distance_count() const { return obstacle_contacts.size() + pairs.size(); }
  std::size_t contact_count() const { return distance_count() + frictions_.size(); }

  std::vector<SegmentDistance> distances_;            // by pair
  std::vector<ObstacleDistance> obstacle_distances_;  // by contact
  std::vector<FrictionPoint> frictions_;
  double stick_length_ = 0.0;  // [m]
  ContactTerms terms_;
  std::vector<double> energies_;  // by contact [J]
};

}  // namespace fiber
