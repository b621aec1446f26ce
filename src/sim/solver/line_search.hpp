#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace fiber {

/// A sum of energies [J], and of their magnitudes, which bound its rounding errors.
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

  /// Rounding errors are below this [J]: energies that differ by less cannot tell which is lower.
  double roundoff() const { return 1e-13 * magnitude; }
};

/// A backtracking line search along Newton's step, for each island by itself: halves the share of
/// the step until it brings a sufficient decrease (Armijo 1966; Nocedal and Wright 2006, Alg. 3.1).
/// Then it interpolates once: where the parabola through the known values has its minimum far
/// before the share, that minimum is tried. A rod between two walls would swing to and fro
/// otherwise.
class LineSearch {
 public:
  struct Island {
    EnergySum accepted;               ///< where the step begins
    double predicted_decrease = 0.0;  ///< by the directional derivative, for a whole step [J]
    double share = 1.0;               ///< of the step that is tried
    bool is_searching = true;         ///< if not, `share` is the accepted one; 0 if none was
    bool has_failed = false;

    /// Where along the step that parabola has its minimum: above 1 where all of the step is too
    /// short (Nocedal and Wright 2006, Eq. 3.57).
    double expected_share = 1.0;
  };

  static constexpr int max_halvings = 40;

  /// Begins a search. The caller sets the islands' energies, decreases and first shares.
  void begin(std::size_t islands, int halvings) {
    islands_.assign(islands, Island{});
    halvings_left_ = halvings;
  }

  Island& island(std::size_t index) { return islands_[index]; }
  const Island& island(std::size_t index) const { return islands_[index]; }

  /// Tells that something else than the search has found where an island goes.
  void accept_whole_step(std::size_t index) {
    islands_[index].share = 1.0;
    islands_[index].expected_share = 1.0;
    islands_[index].has_failed = false;
  }

  /// Searches. The trial step that was evaluated last is the one that each island accepts.
  /// @param evaluate returns the energies, by island, where the islands' shares lead
  template <class Evaluate>
  void run(const Evaluate& evaluate) {
    do {
      energies_ = evaluate();
    } while (backtrack());
    bool must_return = std::any_of(islands_.begin(), islands_.end(),
                                   [](const Island& island) { return island.has_failed; });
    if (interpolate()) {
      must_return = keep_better(evaluate());
    }
    if (must_return) {
      evaluate();
    }
  }

 private:
  /// Halves the shares of islands whose energy has not decreased sufficiently.
  /// @returns whether there are any
  bool backtrack() {
    constexpr double sufficient = 1e-4;  // of the predicted decrease
    const bool is_last = halvings_left_-- == 0;
    bool is_any_searching = false;
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      Island& island = islands_[i];
      if (!island.is_searching) {
        continue;
      }
      const double required = sufficient * island.share * std::max(0.0, island.predicted_decrease);
      island.is_searching =
          !(energies_[i].energy <= island.accepted.energy - required + island.accepted.roundoff());
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

  /// Moves shares that went far beyond the expected minimum to that minimum.
  /// @returns whether there are any
  bool interpolate() {
    constexpr double far_beyond = 0.6;  // the minimum is before this part of the share
    constexpr double max_share = 16.0;
    bool is_any_interpolated = false;
    backtracked_shares_.assign(islands_.size(), 0.0);
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      Island& island = islands_[i];
      const double predicted = island.share * island.predicted_decrease;
      if (predicted <= 0.0) {
        continue;
      }
      // The difference between the linear prediction and the energy is the parabola's curvature.
      const double shortfall = predicted - (island.accepted.energy - energies_[i].energy);
      island.expected_share = shortfall > island.accepted.roundoff()
                                  ? std::min(max_share, 0.5 * island.share * predicted / shortfall)
                                  : 1.0;
      if (island.expected_share < far_beyond * island.share) {
        backtracked_shares_[i] = island.share;
        island.share = island.expected_share;
        is_any_interpolated = true;
      }
    }
    return is_any_interpolated;
  }

  /// Returns to the share before interpolation where its energy was lower.
  /// @param interpolated energies, by island
  /// @returns whether there are such islands
  bool keep_better(const std::vector<EnergySum>& interpolated) {
    bool is_any_reverted = false;
    for (std::size_t i = 0; i < islands_.size(); ++i) {
      if (backtracked_shares_[i] > 0.0 && !(interpolated[i].energy <= energies_[i].energy)) {
        islands_[i].share = backtracked_shares_[i];
        is_any_reverted = true;
      }
    }
    return is_any_reverted;
  }

  std::vector<Island> islands_;
  std::vector<EnergySum> energies_;         // of the last trial step of backtracking, by island
  std::vector<double> backtracked_shares_;  // before interpolation; 0 where there was none
  int halvings_left_ = 0;
};

}  // namespace fiber
