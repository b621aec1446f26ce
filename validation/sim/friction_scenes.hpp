#pragma once

#include <memory>
#include <string>

#include "fiber_proximity/sim/stepper.hpp"

namespace fiber {

/// A rod across a plane of this slope, at rest, that slides or creeps down.
class Incline {
 public:
  /// @param angle    [rad]
  /// @param friction coefficient
  Incline(double angle, double friction);

  /// @param time [s]
  void run(double time);

  /// The speed of the whole rod, downwards [m/s].
  double speed() const;

  /// The forces of friction on the whole rod, upwards, and of the plane that presses on it [N].
  double friction_force() const;
  double normal_force() const;

  double weight() const;  ///< [N]

 private:
  double mass() const;

  Eigen::Vector3d down_;
  Eigen::Vector3d normal_;
  std::unique_ptr<Stepper> stepper_;
};

/// A rope around a post along z: which part of a turn, in how many edges, and what it is made of,
/// one of material_names(). A constant force pulls at one end, and is as large as it takes for the
/// rope's stiffness not to matter: EI/TR² is 1e-3. The rope is as thin as that allows without much
/// strain.
struct Capstan {
  double turns;
  int edges_per_turn;
  std::string material = "rope";
};

/// Ratio of the tensions beyond and before a post over which a rope is drawn, on the mean of the
/// time in which it moves by an edge.
/// @throws std::runtime_error if more than a twentieth of the steps end short of balance
double tension_ratio(const Capstan& capstan, double friction);

/// The same where the rope is held and the post turns under it, as a drum does under a belt.
double tension_ratio_on_drum(const Capstan& capstan, double friction);

/// What a belt around two drums does, one of which turns and the other one stands.
struct BeltDrive {
  double tension_ratio;  ///< of its tight and its slack side
  double speed;          ///< along itself, over that of the surface of the drum that turns
};

constexpr int belt_edges_per_turn = 72;  ///< of the small drum

/// A closed rope, a little too short, around a drum and one of half its size.
/// @param turns_large whether the large drum turns, and not the small one
BeltDrive simulated_belt_drive(bool turns_large, double friction);

/// It slips on the small one, which it is around by the smaller angle (Euler and Eytelwein), and
/// grips the large one, on whose surface its inside is.
BeltDrive exact_belt_drive(bool turns_large, double friction);

/// A rod without weight hangs from a clamp that points down and is lowered onto a plane, slowly:
/// how much nearer to its tip than its length the clamp is where the tip slides, over the length.
double lowering_of_simulated_tip(double friction, int segments);

}  // namespace fiber
