#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fiber {

/// A sum of energies, and of their magnitudes, which rounding errors are a part of [J].
struct EnergySum {
  double energy = 0.0;
  double magnitude = 0.0;

  void add(double part) {
    energy += part;
    magnitude += std::abs(part);
  }

  void add(const EnergySum& part) {
    energy += part.energy;
    magnitude += part.magnitude;
  }

  /// What rounding errors may be [J]: a step that changes less cannot be judged by its energy.
  double roundoff() const { return 1e-13 * magnitude; }
};

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
  bool judge(const std::vector<EnergySum>& tried) {
    constexpr double sufficient = 1e-4;  // of what the slope promises
    const bool is_last = halvings_left_-- == 0;
    bool is_any_searching = false;
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      Island& island = islands_[i];
      if (!island.is_searching) {
        continue;
      }
      const double promised = sufficient * island.share * std::max(0.0, island.decrease);
      island.is_searching =
          !(tried[i].energy <= island.accepted.energy - promised + island.accepted.roundoff());
      if (island.is_searching && (is_last || island.share == 0.0)) {
        island.is_searching = false;
        island.has_failed = true;
        island.share = 0.0;
      }
      island.share *= island.is_searching ? 0.5 : 1.0;
      is_any_searching |= island.is_searching;
    }
    return is_any_searching;
  }

  /// Has what was found been judged, tries less of steps that went far too far.
  /// @param found energies where the shares lead, by island
  /// @returns whether there are such islands
  bool refine(const std::vector<EnergySum>& found) {
    constexpr double far_too_far =
        0.6;  // the minimum is expected before this part of what was found
    constexpr double most = 16.0;
    bool is_any_refined = false;
    found_energies_ = found;
    found_shares_.assign(islands_.size(), 0.0);
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      Island& island = islands_[i];
      const double promised = island.share * island.decrease;
      if (promised <= 0.0) {
        continue;
      }
      // What curvature has taken of it.
      const double taken = promised - (island.accepted.energy - found[i].energy);
      island.expected_share = taken > island.accepted.roundoff()
                                  ? std::min(most, 0.5 * island.share * promised / taken)
                                  : 1.0;
      if (island.expected_share < far_too_far * island.share) {
        found_shares_[i] = island.share;
        island.share = island.expected_share;
        is_any_refined = true;
      }
    }
    return is_any_refined;
  }

  /// Goes back to what was found before, where that was better.
  /// @param tried energies where the refined shares lead, by island
  /// @returns whether there are such islands
  bool settle(const std::vector<EnergySum>& tried) {
    bool is_any_back = false;
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      if (found_shares_[i] > 0.0 && !(tried[i].energy <= found_energies_[i].energy)) {
        islands_[i].share = found_shares_[i];
        is_any_back = true;
      }
    }
    return is_any_back;
  }

 private:
  std::vector<Island> islands_;
  std::vector<double> found_shares_;  // before they were refined; 0 of what was not
  std::vector<EnergySum> found_energies_;
  int halvings_left_ = 0;
};

}  // namespace fiber
