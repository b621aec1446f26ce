#pragma once

#include "merit.hpp"
#include "rod_batch.hpp"

namespace fiber {

/// Keeps steps from adding energy that nothing has brought: what implicit midpoint finds on the far
/// side of the middle is not a minimum of anything, and where rods are stiff it may be far too
/// high. Rods whose step does that take it again, by a method that cannot.
class EnergyGuard {
 public:
  /// Where all rods are, and how they move.
  struct Motion {
    std::vector<Eigen::Vector3d> positions;
    std::vector<Eigen::Vector3d> velocities;
    std::vector<double> angles;
    std::vector<double> spins;
  };

  explicit EnergyGuard(std::uint32_t rod_count) : gained_(rod_count, 0.0) {}

  /// Remembers rods, and measures their energy; effects have begun the step.
  void begin(const Rods& rods, const Effects& effects);
  const Motion& beginning() const { return beginning_; }

  /// Measures what the step has brought.
  /// @returns the rods that have gained energy; brought back to where they were
  std::vector<std::uint32_t> bring_back_gained(Rods& rods, const Effects& effects);

  /// Measures the energy of rods that have taken their step again: what they have lost, they may
  /// gain.
  void accept_again(const std::vector<std::uint32_t>& which, const Rods& rods,
                    const Effects& effects);

 private:
  void bring_back(std::uint32_t rod, Rods& rods) const;

  std::vector<double> gained_;  // by rod, in all steps so far [J]
  std::vector<Merit> before_;   // by rod
  Motion beginning_;            // of the step
};

}  // namespace fiber
