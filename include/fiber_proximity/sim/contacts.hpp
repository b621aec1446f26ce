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
  /// accepted contacts [J].
  double measure(const Rods& rods);

  /// Accepts the contacts found last: the following functions are about them.
  void accept() { points_.swap(found_); }

  /// Their energy, where the rods were when they were found [J].
  double energy(const Rods& rods) const { return energy_of(points_, rods); }

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

  /// Shortens displacements so that nothing passes through anything.
  void limit(const Rods& rods, std::vector<Eigen::Vector3d>& displacements);

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
  double energy_of(const std::vector<ContactPoint>& points, const Rods& rods) const;

  std::vector<std::unique_ptr<ContactSource>> sources_;
  std::unique_ptr<Friction> friction_;
  std::vector<ContactPoint> points_;
  std::vector<ContactPoint> found_;
  std::vector<std::vector<ContactPoint>> found_by_;  // by source
  std::vector<Term> terms_;
};

}  // namespace fiber
