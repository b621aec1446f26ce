// What a group does about rods that a step leaves with more energy than they can have.

#include <algorithm>
#include <cmath>

#include "rod_group.hpp"

namespace fiber {

/// Finds rods that inertia has thrown where few iterations do not lead back from, as it does with
/// something stiff, and brings them where they keep their shapes: that is nearer to what they do.
/// @param limits_energy what rods may end with is to be known as well
/// @returns true if there are any; their searches are active then
bool RodGroup::restart_lost(Rods& rods, const Effects& effects, bool limits_energy) {
  for_each_batch(Work::MUCH, [&](std::size_t index) {
    RodBatch& batch = batches_[index];
    batch.remember();
    const auto measure_here = [&] {
      batch.store_for(effects, rods);
      batch.measure(rods, effects);
    };
    batch.stay();
    if (limits_energy) {
      measure_here();
      batch.limit_energy();
    }
    if (batch.drift() || !limits_energy) {
      measure_here();
    }
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const Merit& carried = batch.merit(lane);
      is_found_[index][lane] = batch.accepted(lane).energy <= carried.energy + carried.unseen();
    }
    batch.restore(is_found_[index]);
  });
  for (Search& search : searches_) {
    search.is_active = false;
  }
  bool is_any_lost = false;
  for_each_rod(
      [&](std::size_t batch, std::size_t lane) { is_any_lost |= !is_found_[batch][lane]; });
  if (is_any_lost && contacts_ != nullptr) {
    rods.positions = beginning_;
    contacts_->measure(rods, contact_energies_);
    limit_start(rods, effects);
  }
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    const bool is_moved =
        contacts_ != nullptr && is_any_lost && is_limited(rods, batches_[batch].rod(lane));
    search_of(batch, lane).is_active |= !is_found_[batch][lane] || is_moved;
  });
  join_searches();
  return is_any_lost;
}

}  // namespace fiber
