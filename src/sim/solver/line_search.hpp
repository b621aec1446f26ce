#pragma once

#include <cstdint>
#include <vector>

#include "src/sim/solver/energy_sum.hpp"

namespace fiber {

/// Backtracking on the energy, for each island by itself: half the share of a step until it brings
/// what its slope promises (Armijo 1966; Nocedal and Wright 2006, Alg. 3.1).
class LineSearch {
 public:
  struct Island {
    EnergySum accepted;        ///< where the step begins
    double decrease = 0.0;     ///< that the slope promises for a whole step [J]
    double share = 1.0;        ///< of the step that is tried
    bool is_searching = true;  ///< if not, `share` is what was found; 0 if none was
    bool has_failed = false;
  };

  static constexpr int most_halvings = 40;

  /// Begins a search; its islands are to be told what to search for, and the first shares to try.
  /// @param islands  how many
  /// @param halvings the most
  void begin(std::size_t islands, int halvings) {
    islands_.assign(islands, Island{});
    halvings_left_ = halvings;
  }

  Island& island(std::size_t index) { return islands_[index]; }
  const Island& island(std::size_t index) const { return islands_[index]; }

  /// @param tried energies where the shares lead, by island
  /// @returns whether there are islands for which other shares are to be tried
  bool judge(const std::vector<EnergySum>& tried);

 private:
  std::vector<Island> islands_;
  int halvings_left_ = 0;
};

}  // namespace fiber
