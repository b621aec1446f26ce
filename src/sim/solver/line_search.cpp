#include "src/sim/solver/line_search.hpp"

#include <algorithm>

namespace fiber {

bool LineSearch::judge(const std::vector<EnergySum>& tried) {
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

bool LineSearch::refine(const std::vector<EnergySum>& found) {
  constexpr double far_too_far = 0.6;  // the minimum is expected before this part of what was found
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

bool LineSearch::settle(const std::vector<EnergySum>& tried) {
  bool is_any_back = false;
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    if (found_shares_[i] > 0.0 && !(tried[i].energy <= found_energies_[i].energy)) {
      islands_[i].share = found_shares_[i];
      is_any_back = true;
    }
  }
  return is_any_back;
}

}  // namespace fiber
