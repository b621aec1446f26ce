#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/sim/contact_source.hpp"
#include "fiber_proximity/sim/effects/friction.hpp"

namespace fiber {

/// All contacts of a simulation: what couples one rod to another. The potential of a contact is
/// that of a spring, ½ k depth², and of its friction.
class Contacts {
 public:
  /// @param friction null for none
  Contacts(std::vector<std::unique_ptr<ContactSource>> sources, std::unique_ptr<Friction> friction);

  void begin_step(const Rods& rods, const TimeStep& step);

  /// Finds what touches where the rods are now, and its energy, together with the friction of the
  /// accepted contacts.
  /// @param energies [J] by rod, overwritten; that of contacts of two is that of one of them
  void measure(const Rods& rods, std::vector<double>& energies);

  /// Makes one island of rods that touch where they were measured last.
  void join_found();

  /// Makes one island of rods that may touch where islands go shares of displacements.
  void join(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements);

  /// Accepts, of the contacts found last, those of some islands: the following functions are about
  /// them.
  /// @param of_rods whether a rod's contacts are accepted
  void accept(const std::vector<bool>& of_rods);

  /// Their energies, where the rods were when they were found, as measure() gives them.
  void energies(const Rods& rods, std::vector<double>& energies) const;

  /// The same without friction, which stores nothing.
  void stored_energies(const Rods& rods, std::vector<double>& energies) const;

  /// Rods that have touched each other in this step, or may have in shares of displacements that
  /// were limited.
  const Islands& islands() const { return islands_; }

  /// Adds gradients, and of the Hessian all that is within one rod; nodes that are held do not
  /// count.
  /// @param systems by rod
  void add_derivatives(const Rods& rods, const std::vector<RodSystem*>& systems);

  /// True if some contact joins two parts of the rods.
  bool has_coupling() const;

  /// Adds what of the Hessian's product with displacements joins two parts of rods.
  /// @param places        of each node's x in these arrays; y and z are lane_count further each
  /// @param displacements of all that is unknown
  void add_coupling(const std::vector<std::size_t>& places, const double* displacements,
                    double* product) const;

  /// Shortens displacements so that nothing passes through anything. Where islands go shares of
  /// them, joins those that may touch.
  void limit(const Rods& rods, std::vector<Eigen::Vector3d>& displacements, ContactSource::Way way);

  const std::vector<ContactPoint>& points() const { return points_; }

 private:
  /// A contact in the equations: by the difference of its points.
  struct Term {
    std::uint32_t node_a;
    std::uint32_t node_b;
    Eigen::Vector2d weights_a;  // of the node and the next; 0 where one is held
    Eigen::Vector2d weights_b;
    Eigen::Matrix3d hessian;
  };

  template <class Function>
  void for_each_source(const Function& function);
  static void set_springs(const std::vector<ContactPoint>& points, const Rods& rods,
                          std::vector<double>& energies);
  void add_friction(const Rods& rods, std::vector<double>& energies) const;

  std::vector<std::unique_ptr<ContactSource>> sources_;
  std::unique_ptr<Friction> friction_;
  Islands islands_;
  std::vector<ContactPoint> points_;
  std::vector<ContactPoint> found_;
  std::vector<std::vector<ContactPoint>> found_by_;  // by source
  std::vector<Term> terms_;
};

}  // namespace fiber
