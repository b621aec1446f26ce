#pragma once

#include <memory>
#include <vector>

#include "fiber_proximity/sim/contacts.hpp"
#include "fiber_proximity/sim/effect.hpp"

namespace fiber {

/// @throws std::runtime_error naming rod, node and value for the first position, velocity, angle or
///         spin that is not finite
void require_finite(const Rods& rods);

class EnergyGuard;
enum class Gains;

/// Rods of equal sizes, by batch: as many as are moved side by side.
using Batches = std::vector<std::vector<std::uint32_t>>;

enum class Integrator {
  IMPLICIT_EULER,  ///< damps what it does not resolve; for everything that should settle

  /// Keeps the energy of undamped motion, and its order in time is two. A rod that is too stiff for
  /// it, and so gains energy in a step, takes this one by implicit Euler. Not for contacts: what
  /// they stop, it would throw on.
  IMPLICIT_MIDPOINT
};

struct StepperOptions {
  Integrator integrator = Integrator::IMPLICIT_EULER;

  /// Newton iterations a step, at least 1; as many again, from the shape that the rod had, where
  /// the first ones end higher than that.
  std::uint32_t iterations = 2;

  /// [m] A rod whose Newton step is smaller everywhere needs no further one; >= 0.
  double tolerance = 1e-9;

  /// Most threads to use, 0 for as many as there are cores.
  std::uint32_t threads = 0;
};

/// Moves rods by the effects a scene calls for: discrete elastic rods in implicit time steps
/// (Bergou et al. 2008, 2010), each the minimum of kinetic and potential energy near where the rods
/// were (Martin et al. 2011, Eq. 4), found by Newton's method with a line search. One banded
/// factorisation per rod and iteration; where contacts join rods, conjugate gradients with these
/// factors as preconditioner. The result does not depend on the threads.
class Stepper {
 public:
  /// @param contacts null for none; nothing is computed for them then
  /// @throws std::invalid_argument for options that are not allowed
  Stepper(Rods rods, std::vector<std::unique_ptr<Effect>> effects,
          const StepperOptions& options = {}, std::unique_ptr<Contacts> contacts = nullptr);
  ~Stepper();
  Stepper(const Stepper&) = delete;
  Stepper& operator=(const Stepper&) = delete;

  /// @param length [s]
  /// @throws std::invalid_argument for a length that is not positive and finite
  /// @throws std::runtime_error where the step diverges, as require_finite(); the rods are in no
  ///         defined state then
  void step(double length);

  const Rods& rods() const { return rods_; }
  Rods& rods() { return rods_; }

  /// [s] since the beginning
  double time() const { return time_; }

 private:
  struct Workers;

  void step_by_midpoint(double length);
  void begin(const TimeStep& step);
  void solve(const std::vector<Batches>& parts, double length, Gains gains);

  Rods rods_;
  std::vector<std::unique_ptr<Effect>> effects_;
  StepperOptions options_;
  double time_ = 0.0;
  std::unique_ptr<Contacts> contacts_;
  std::unique_ptr<Workers> workers_;
  std::unique_ptr<EnergyGuard> guard_;  // of implicit midpoint
};

}  // namespace fiber
