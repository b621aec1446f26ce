// What a group does about rods that inertia has thrown where no step leads back from.

#include "rod_group.hpp"

namespace fiber {

/// Measures what rods and contacts may end with: that of staying where they are now.
void RodGroup::limit_energy(Rods& rods, const Effects& effects) {
  for_each_batch(Work::MUCH, [&](std::size_t index) {
    RodBatch& batch = batches_[index];
    if (contacts_ != nullptr) {
      batch.store(rods);
    } else {
      batch.store_for(effects, rods);
    }
    batch.measure(rods, effects);
    batch.limit_energy();
  });
  if (contacts_ != nullptr) {
    contacts_->measure(rods, allowed_contacts_);
  }
}

/// Finds rods that inertia has thrown where few iterations do not lead back from, as it does with
/// something stiff, and brings them where they keep their shapes: that is nearer to what they do.
/// @returns true if there are any; their searches are active then
bool RodGroup::restart_lost(Rods& rods, const Effects& effects, Gains gains) {
  for_each_batch(Work::LITTLE, [&](std::size_t batch) {
    batches_[batch].remember();
    batches_[batch].stay();
  });
  if (gains == Gains::TAKEN) {
    limit_energy(rods, effects);
  }
  for_each_batch(Work::MUCH, [&](std::size_t index) {
    RodBatch& batch = batches_[index];
    if (batch.drift() || gains == Gains::LEFT) {
      batch.store_for(effects, rods);
      batch.measure(rods, effects);
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
    limit_again(rods, effects);
  }
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    const bool is_moved =
        contacts_ != nullptr && is_any_lost && is_limited(rods, batches_[batch].rod(lane));
    search_of(batch, lane).is_active |= !is_found_[batch][lane] || is_moved;
  });
  return is_any_lost;
}

}  // namespace fiber
