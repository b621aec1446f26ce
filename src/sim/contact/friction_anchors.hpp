#pragma once

#include <cstdint>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "src/sim/contact/contact_terms.hpp"

namespace fiber {

/// The slips at which contacts with friction ended a step: elastic ones, which their friction
/// begins the next step with. So what sticks holds a load at rest, as the bristles of a surface do
/// (Cundall and Strack 1979), and does not creep.
class FrictionAnchors {
 public:
  /// The friction of a contact at the end of a step.
  struct Anchor {
    ContactPoints points;
    Eigen::Vector3d normal;  ///< of length 1
    Eigen::Vector3d slip;    ///< in parts of the stick length: of length 1 where it slides
    double energy;           ///< [J]
  };

  void clear() { anchors_.clear(); }
  void add(const Anchor& anchor) { anchors_.push_back(anchor); }

  /// To be called after the last add().
  /// @param edges number of them, as Rods counts edges
  void sort(std::size_t edges);

  /// Removes those at an object; the objects behind it are counted from one less then.
  void remove_object(std::uint32_t object);

  /// The energy of all [J].
  double energy() const { return energy_; }

  /// That which a contact goes on with: the nearest one between the same two bodies, which lies no
  /// more than one edge away on either. Contacts wander over the edges of a rod, and end and begin
  /// at their nodes.
  /// @returns null where none lies near enough; valid until the next add() or clear()
  const Anchor* nearest(const ContactPoints& points, const Eigen::Vector3d& normal) const;

  /// The slip with which a contact begins that goes on with an anchor. Where it presses more than
  /// that did, its slip is less, so that its energy is no more.
  /// @param max_force    of friction [N]
  /// @param stick_length [m]
  /// @returns in [m]
  static Eigen::Vector3d slip_from(const Anchor& anchor, double max_force, double stick_length);

 private:
  std::vector<Anchor> anchors_;
  std::vector<std::uint32_t> by_edge_;  // anchors, in the order of their edges of rod a
  std::vector<std::uint32_t>
      offsets_;  // by edge: where its anchors begin in by_edge_; then the end
  double energy_ = 0.0;
};

}  // namespace fiber
