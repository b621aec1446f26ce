// What energies rods of a batch have, and may have at the end of a step.

#include "lane_sums.hpp"
#include "rod_batch.hpp"

namespace fiber {

void RodBatch::measure(const Rods& rods, const Effects& effects) {
  const Lanes kinetic = weighted_squares(system_.size(), inertias_.data(), lanes_.positions.data(),
                                         predicted_.data());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    merits_[lane] = Merit{};
    merits_[lane].add(0.5 * kinetic[lane] / (step_length_ * step_length_));
  }
  for (std::size_t e = 0; e < effects.size(); ++e) {
    Lanes energy;
    if (effects[e]->works_in_lanes(rods)) {
      effects[e]->energy_in_lanes(lanes_, values_[e], energy);
    } else {
      for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
        energy[lane] = effects[e]->energy(rods, lanes_.rods[lane]);
      }
    }
    for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
      merits_[lane].add(energy[lane]);
    }
  }
}

/// With the velocity of moving somewhere from where the step began, in place of what merits have.
Lanes RodBatch::energy_with(const std::array<Merit, lane_count>& merits,
                            const std::vector<Lanes>& moved_to) const {
  const Lanes moved =
      weighted_squares(system_.size(), inertias_.data(), moved_to.data(), beginning_.data());
  const Lanes missed = weighted_squares(system_.size(), inertias_.data(), lanes_.positions.data(),
                                        predicted_.data());
  Lanes energy;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    energy[lane] =
        merits[lane].energy + 0.5 * (moved[lane] - missed[lane]) / (step_length_ * step_length_);
  }
  return energy;
}

Lanes RodBatch::gains() const {
  Lanes gains = energy_with(accepted_, lanes_.positions);
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    gains[lane] -= allowed_[lane];
  }
  return gains;
}

}  // namespace fiber
