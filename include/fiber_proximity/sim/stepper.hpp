#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/effect.hpp"
#include "fiber_proximity/sim/forces.hpp"
#include "fiber_proximity/sim/joints.hpp"

namespace fiber {

/// @throws std::runtime_error naming rod, node and value for the first position, velocity, angle or
///         spin that is not finite
void require_finite(const Rods& rods);

class StageSolver;

enum class Integrator {
  IMPLICIT_EULER,  ///< of first order; damps what it does not resolve, for what should settle

  /// The backward differentiation formula of second order (Hairer and Wanner 1996, Sect. III.1 and
  /// V.1): like implicit Euler as stiff as may be, and keeps swings and spins. Its first step, and
  /// the first after rods have been changed from outside, is one of SDIRK2 (Alexander 1977,
  /// Eq. 3.1).
  BDF2
};

/// The time integration, and the tolerances of its solver.
struct StepperOptions {
  Integrator integrator = Integrator::IMPLICIT_EULER;

  /// Newton's method goes on until no force would change the speed of its node in a step by more
  /// than this [m/s]; > 0.
  double residual = 1e-3;

  /// Most iterations of Newton's method in a solve, at least 1. A step that ends by this is not yet
  /// balanced: StepReport says how far it is from that.
  std::uint32_t max_iterations = 100;

  /// Most threads to use, 0 for as many as there are cores.
  std::uint32_t threads = 0;
};

/// The result of Newton's method for an island, which is a set of rods that may touch each other in
/// a step.
struct IslandReport {
  std::uint32_t iterations = 0;  ///< of Newton's method
  double residual = 0.0;         ///< largest change of speed that is left [m/s]
  double residual_force = 0.0;   ///< the force that makes it, of its node [N]
  std::uint32_t rod = 0;         ///< whose residual that is
  std::uint32_t node = 0;        ///< counted from the rod's first one
  std::uint32_t impacts = 0;     ///< contacts that shared in an impact, or in what it left

  /// Points of contacts that press along their normals in the middle of the step: along those at
  /// its end they would have pushed rods on along their way, and gained energy.
  std::uint32_t midpoint_contacts = 0;
};

/// The result of a step.
struct StepReport {
  std::uint32_t iterations = 0;    ///< the most of an island, all solves of the step together
  std::uint32_t unbalanced = 0;    ///< islands that have not converged to the residual asked for
  IslandReport worst;              ///< the island with the largest residual
  std::uint32_t coupled_rods = 0;  ///< that were solved together with others

  std::uint32_t impacts = 0;            ///< of all islands, as in IslandReport
  std::uint32_t midpoint_contacts = 0;  ///< of all islands, alike

  /// Whether a step of BDF2 was one of implicit Euler, because a contact began in it or in the one
  /// before.
  bool is_first_order = false;

  /// The increase of kinetic and stored energy by the step, without the work of its input [J]. A
  /// converged step of implicit Euler gains none where the stored energy is convex on its way.
  /// Where it is not, as in buckling, it may gain what is left of the kinetic energy of the end
  /// less that of how speeds have changed, and so may a step that its iterations cut short; by
  /// contacts only the latter. Such a step may gain more where friction grew in it with its normal
  /// forces, or impacts changed speeds.
  double energy_gain = 0.0;
};

struct MovingObstacle;

/// Moves rods by the effects a scene calls for: discrete elastic rods in implicit time steps
/// (Bergou et al. 2008, 2010), each a minimum of the incremental potential near where the rods were
/// (Martin et al. 2011, Eq. 4): of kinetic, potential and contact energy. Newton's method finds it
/// to a stated residual, so that where nothing moves, forces balance. No step goes further than a
/// proven part of the way to the first contact. The result does not depend on the threads.
class Stepper {
 public:
  /// @param contacts null for none; nothing is computed for them then
  /// @param joints   of these rods; null for none, alike
  /// @throws std::invalid_argument for options that are not allowed
  Stepper(Rods rods, Effects effects, const StepperOptions& options = {},
          std::unique_ptr<Contacts> contacts = nullptr, std::unique_ptr<Joints> joints = nullptr);
  ~Stepper();
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// @param length [s]
  /// @throws std::invalid_argument for a length that is not positive and finite
  /// @throws std::runtime_error where the step diverges, as require_finite(); the rods are in no
  ///         defined state then
  void step(double length);

  /// Goes on from where another one is, with its rods. Effects, options, contacts and joints of
  /// both must have been made alike, effects in the same order.
  void take_state(const Stepper& other);

  const Rods& rods() const { return rods_; }
  Rods& rods() { return rods_; }

  /// [s] since the beginning
  double time() const { return time_; }

  /// Null for none.
  const Joints* joints() const { return joints_.get(); }

  /// The motions of obstacles; null for none. They may be redirected between two steps.
  ObstacleMotions* moving_obstacles() const;

  /// Whether there may be some: whether its contacts have motions.
  bool takes_moving_obstacles() const;

  /// Adds one behind the others, whatever is there now. As after take_state(), forces are those of
  /// the next step.
  /// @throws std::invalid_argument as ObstacleMotions::add(), or if it takes none
  void add_obstacle(MovingObstacle obstacle);

  /// Removes one of those that move; those behind it are counted from one less then.
  /// @throws std::invalid_argument if there is no such one
  void remove_obstacle(std::uint32_t obstacle);

  /// The result of the last step.
  const StepReport& report() const { return report_; }

  /// The forces in and on the rods at the end of the last step; before the first one, and the first
  /// one after take_state() and after obstacles have come or gone, none.
  RodForces forces() const;

  /// Kinetic and stored energy [J], also of contacts, where the rods are; before the first step
  /// the kinetic one alone.
  double energy();

 private:
  /// The last step, for BDF2.
  struct History {
    RodState before;      // the last step
    RodState after;       // the last step
    double length = 0.0;  // of the last step [s]; 0 where there was none
    bool has_impacts = false;
    RodState begin;      // buffer: the beginning of this step
    RodState reference;  // buffer: where rates of this step are measured from
  };

  void step_by_bdf2(double length);
  bool is_solved_by_bdf2(double length);
  bool is_solved_by_sdirk2(double length);

  Rods rods_;
  Effects effects_;
  StepperOptions options_;
  double time_ = 0.0;
  bool has_step_ = false;  // of its own
  StepReport report_;
  History history_;
  std::unique_ptr<Contacts> contacts_;
  std::unique_ptr<Joints> joints_;
  std::unique_ptr<StageSolver> solver_;
};

}  // namespace fiber
