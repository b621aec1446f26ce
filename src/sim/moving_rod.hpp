#pragma once

#include <cmath>
#include <memory>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

using Effects = std::vector<std::unique_ptr<Effect>>;

/// A sum of energies, and of their magnitudes, which rounding errors are a part of [J].
struct Merit {
  double energy = 0.0;
  double magnitude = 0.0;

  void add(double part) {
    energy += part;
    magnitude += std::abs(part);
  }
  void add(const Merit& part) {
    energy += part.energy;
    magnitude += part.magnitude;
  }

  /// A step that changes less than the last digits cannot be judged by them: small motion of a rod
  /// under large stress would come to rest.
  double unseen() const { return 1e-12 * magnitude; }
};

/// One rod in a step of implicit Euler: where it began, where inertia alone would bring it, and the
/// incremental potential of where it is now. Keeps the memory for that.
class MovingRod {
 public:
  MovingRod(const Rods& rods, std::uint32_t rod);

  /// Remembers where the rod is, and moves it to where inertia and what holds it bring it.
  /// @param step [s]
  void begin(Rods& rods, double step);

  /// Kinetic and potential energy where the rod is now [J].
  Merit merit(const Rods& rods, const Effects& effects) const;

  /// Makes the system() that of the merit where the rod is now; what is held still moves in it.
  void assemble(const Rods& rods, const Effects& effects);

  /// Holds what is held and factorises.
  void factorise();

  /// Remembers where the rod is as where a move() starts.
  void store(const Rods& rods) { store(rods, iterate_); }

  /// Brings the rod back there.
  void restore(Rods& rods) const;

  /// Brings the rod to where inertia and what holds it bring it, as begin() does.
  void predict(Rods& rods) const;

  /// Brings the rod to where it began, in its shape, but for the nodes that are held; if there are
  /// none, moved on with its momentum.
  void carry(Rods& rods) const;

  /// Brings the rod a share of the displacements away from where it was stored.
  /// @param displacements of all that is unknown
  void move(Rods& rods, const double* displacements, double share) const;

  /// Velocities become those that bring the rod from where it began to where it is.
  void finish(Rods& rods) const;

  RodSystem& system() { return system_; }
  const std::vector<Eigen::Vector3d>& beginning() const { return begin_.positions; }

  /// Nodes that are held, from the rod's first one.
  const std::vector<std::uint32_t>& held() const { return held_; }

 private:
  /// What is unknown of a rod.
  struct State {
    std::vector<Eigen::Vector3d> positions;
    std::vector<double> angles;
  };

  void store(const Rods& rods, State& state) const;
  void load(const State& state, Rods& rods) const;

  std::uint32_t rod_;
  std::uint32_t first_;
  std::uint32_t count_;
  RodSystem system_;
  State begin_;
  State predicted_;
  State iterate_;
  std::vector<std::uint32_t> held_;
  double step_ = 0.0;
};

}  // namespace fiber
