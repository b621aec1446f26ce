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

}  // namespace fiber
