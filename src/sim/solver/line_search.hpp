#pragma once

#include <cstdint>
#include <vector>

#include "src/sim/solver/energy_sum.hpp"

namespace fiber {

/// A search along a step, for each island by itself: half the share of the step until it brings
/// what its slope promises (Armijo 1966; Nocedal and Wright 2006, Alg. 3.1), then less where the
/// parabola through what is known has its minimum far before that: what swings to and fro between
/// two walls would do so time and again otherwise.
class LineSearch {
 public:
  struct Island {
    EnergySum accepted;        ///< where the step begins
    double decrease = 0.0;     ///< that the slope promises for a whole step [J]
    double share = 1.0;        ///< of the step that is tried
    bool is_searching = true;  ///< if not, `share` is what was found; 0 if none was
    bool has_failed = false;

    /// Where along the step that parabola has its minimum: above 1 where all of the step is too
    /// short (Nocedal and Wright 2006, Eq. 3.57).
    double expected_share = 1.0;
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

  /// Has what was found been judged, tries less of steps that went far too far.
  /// @param found energies where the shares lead, by island
  /// @returns whether there are such islands
  bool refine(const std::vector<EnergySum>& found);

  /// Goes back to what was found before, where that was better.
  /// @param tried energies where the refined shares lead, by island
  /// @returns whether there are such islands
  bool settle(const std::vector<EnergySum>& tried);

 private:
  std::vector<Island> islands_;
  std::vector<double> found_shares_;  // before they were refined; 0 of what was not
  std::vector<EnergySum> found_energies_;
  int halvings_left_ = 0;
};

}  // namespace fiber
