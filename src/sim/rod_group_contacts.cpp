// What contacts add to a group of rods: equations that join them, and ways that end where others
// are.

#include <algorithm>
#include <cmath>

#include "rod_group.hpp"

namespace fiber {

using Eigen::Vector3d;

void RodGroup::prepare_coupling(const Rods& rods) {
  systems_.resize(rods.count());
  is_accepting_.resize(rods.count());
  places_.resize(rods.positions.size());
  displacements_.resize(rods.positions.size());
  const std::size_t unknowns = rods.angles.empty() ? 3 : 4;
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    const std::uint32_t rod = batches_[batch].rod(lane);
    systems_[rod] = &batches_[batch].system(lane);
    for (std::uint32_t i = 0; i < rods.node_count(rod); ++i) {
      places_[rods.first(rod) + i] = (offsets_[batch] + i * unknowns) * lane_count + lane;
    }
  });
}

/// From where the contacts were measured, the beginning: neither inertia nor what holds a rod may
/// carry it through another on its way from where it began.
void RodGroup::limit_start(Rods& rods, const Effects& effects) {
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].store(rods); });
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] = rods.positions[i] - beginning_[i];
  }
  ends_ = rods.positions;
  rods.positions = beginning_;
  wanted_ = displacements_;
  contacts_->limit(rods, displacements_, ContactSource::Way::WHOLE);
  for_each_batch(Work::MUCH, [&](std::size_t batch) { stop_torn(rods, effects, batch); });
  rods.positions = beginning_;
  // What stays may be in the way of what follows it.
  contacts_->limit(rods, displacements_, ContactSource::Way::WHOLE);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    if (displacements_[i] != wanted_[i]) {
      ends_[i] = beginning_[i] + displacements_[i];
    }
  }
  rods.positions = ends_;
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].place(rods.positions); });
}

/// The same for other places that they are to end at than they began with.
void RodGroup::limit_again(Rods& rods, const Effects& effects) {
  rods.positions.swap(beginning_);
  contacts_->measure(rods, contact_energies_);
  rods.positions.swap(beginning_);
  limit_start(rods, effects);
}

/// Whether limits have changed what was wanted of a rod.
bool RodGroup::is_limited(const Rods& rods, std::uint32_t rod) const {
  const auto first = static_cast<std::ptrdiff_t>(rods.first(rod));
  const auto end = static_cast<std::ptrdiff_t>(rods.end(rod));
  return !std::equal(wanted_.begin() + first, wanted_.begin() + end,
                     displacements_.begin() + first);
}

/// Where limits have stopped nodes of a rod so that their neighbours are torn from them, only what
/// is held moves: the rod has no more energy than it began with.
void RodGroup::stop_torn(Rods& rods, const Effects& effects, std::size_t index) {
  RodBatch& batch = batches_[index];
  LaneFlags is_stopped{};
  for (std::size_t lane = 0; lane < batch.used(); ++lane) {
    is_stopped[lane] = is_limited(rods, batch.rod(lane));
  }
  if (std::none_of(is_stopped.begin(), is_stopped.end(), [](bool is) { return is; })) {
    return;
  }
  const auto merits_after = [&](const std::vector<Vector3d>& displacements) {
    std::vector<Vector3d> positions = beginning_;
    for (std::size_t lane = 0; lane < batch.used(); ++lane) {
      const std::uint32_t rod = batch.rod(lane);
      for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
        positions[i] += displacements[i];
      }
    }
    batch.place(positions);
    batch.store_for(effects, rods);
    batch.measure(rods, effects);
    std::array<double, lane_count> merits{};
    for (std::size_t lane = 0; lane < batch.used(); ++lane) {
      merits[lane] = batch.merit(lane).energy;
    }
    return merits;
  };
  std::vector<Vector3d> stopped(displacements_.size(), Vector3d::Zero());
  for (std::size_t lane = 0; lane < batch.used(); ++lane) {
    for (const std::uint32_t node : batch.held(lane)) {
      const std::uint32_t held = rods.first(batch.rod(lane)) + node;
      stopped[held] = displacements_[held];
    }
  }
  const std::array<double, lane_count> limited = merits_after(displacements_);
  const std::array<double, lane_count> at_rest = merits_after(stopped);
  for (std::size_t lane = 0; lane < batch.used(); ++lane) {
    if (is_stopped[lane] && limited[lane] > at_rest[lane]) {
      const std::uint32_t rod = batch.rod(lane);
      std::copy(stopped.begin() + rods.first(rod), stopped.begin() + rods.end(rod),
                displacements_.begin() + rods.first(rod));
    }
  }
}

/// Rods that touch where they were measured are searched for together from now on.
void RodGroup::join_touching() {
  contacts_->join_found();
  join_searches();
}

/// Rods that may touch are searched for together from now on.
void RodGroup::join_searches() {
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    islands_[batch][lane] = contacts_->islands().of(batches_[batch].rod(lane));
  });
  for (std::uint32_t rod = 0; rod < searches_.size(); ++rod) {
    const std::uint32_t island = contacts_->islands().of(rod);
    if (island != rod) {
      Search& joined = searches_[island];
      joined.accepted.add(searches_[rod].accepted);
      joined.is_active |= searches_[rod].is_active;
      joined.is_beyond |= searches_[rod].is_beyond;
      searches_[rod] = Search{};
      searches_[rod].is_active = false;
    }
  }
}

/// The energy of contacts, with the friction of those accepted.
void RodGroup::measure_contacts(const Rods& rods) {
  for (Search& search : searches_) {
    search.contacts = Merit{};
  }
  if (contacts_ == nullptr) {
    return;
  }
  contacts_->energies(rods, contact_energies_);
  for (std::uint32_t rod = 0; rod < searches_.size(); ++rod) {
    searches_[contacts_->islands().of(rod)].contacts.add(contact_energies_[rod]);
  }
}

void RodGroup::correct_step() {
  decreases_.clear();
  for (const Search& search : searches_) {
    decreases_.push_back(search.decrease);
  }
  coupled_step_.correct({batches_, offsets_, islands_, decreases_, *contacts_, places_}, step_);
}

/// From the step, of all nodes.
void RodGroup::take_displacements() {
  using Stride = Eigen::InnerStride<lane_count>;
  const double* const step = step_.data()->of.data();
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] = Eigen::Map<const Vector3d, 0, Stride>(step + places_[i]);
  }
}

void RodGroup::limit_step(const Rods& rods) {
  using Stride = Eigen::InnerStride<lane_count>;
  double* const step = step_.data()->of.data();
  take_displacements();
  contacts_->limit(rods, displacements_, ContactSource::Way::SHARES);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    Eigen::Map<Vector3d, 0, Stride>(step + places_[i]) = displacements_[i];
  }
  join_searches();
}

}  // namespace fiber
