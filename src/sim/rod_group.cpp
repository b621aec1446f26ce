#include "rod_group.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

#include "lane_sums.hpp"

namespace fiber {

RodGroup::RodGroup(Contacts* contacts)
    : contacts_(contacts), searches_(contacts != nullptr ? 1 : lane_count) {}

void RodGroup::assign(const Rods& rods, const Batches& batches) {
  batches_.resize(batches.size());
  offsets_.clear();
  std::size_t size = 0;
  for (std::size_t i = 0; i < batches.size(); ++i) {
    batches_[i].assign(rods, batches[i]);
    offsets_.push_back(size);
    size += batches_[i].step_size();
  }
  step_.resize(size);
  is_found_.resize(batches.size());
  if (contacts_ != nullptr) {
    prepare_coupling(rods);
  }
}

/// Without contacts there is one batch.
RodGroup::Search& RodGroup::search_of(std::size_t lane) {
  return searches_[contacts_ != nullptr ? 0 : lane];
}

Lanes* RodGroup::part(std::vector<Lanes>& values, std::size_t batch) {
  return values.data() + offsets_[batch];
}

void RodGroup::solve(Rods& rods, const Effects& effects, const StepperOptions& options, double step,
                     Gains gains) {
  for_each_batch(Work::LITTLE,
                 [&](std::size_t batch) { batches_[batch].begin(rods, effects, step); });
  for (std::size_t i = 0; i < searches_.size(); ++i) {
    searches_[i].is_active = contacts_ != nullptr || i < batches_.front().used();
  }
  if (contacts_ != nullptr) {
    beginning_ = rods.positions;
    limit_start(rods, effects);
  }
  iterate(rods, effects, options);
  const bool limits_energy = gains == Gains::TAKEN && contacts_ == nullptr;
  if (restart_lost(rods, effects, limits_energy)) {
    iterate(rods, effects, options);
  }
  if (limits_energy) {
    batches_.front().slow_down();
  }
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].finish(rods); });
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    for (const std::unique_ptr<Effect>& effect : effects) {
      effect->end_solve(rods, batches_[batch].rod(lane));
    }
  });
}

/// Newton's method from where the rods are.
void RodGroup::iterate(Rods& rods, const Effects& effects, const StepperOptions& options) {
  const auto is_any_active = [this] {
    return std::any_of(searches_.begin(), searches_.end(),
                       [](const Search& search) { return search.is_active; });
  };
  measure(rods, effects);
  for (Search& search : searches_) {
    if (search.is_active) {
      accept(search);
    }
  }
  for (std::uint32_t i = 0; i < options.iterations && is_any_active(); ++i) {
    find_step(rods, effects);
    search_line(rods, effects);
    for (Search& search : searches_) {
      search.is_active = search.is_active && !(search.longest < options.tolerance);
    }
  }
}

/// Measures where the rods are now, with the contacts there.
void RodGroup::measure(Rods& rods, const Effects& effects) {
  for (Search& search : searches_) {
    search.tried = Merit{};
  }
  if (contacts_ == nullptr) {
    batches_.front().store_for(effects, rods);
    batches_.front().measure(rods, effects);
  } else {
    for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].store(rods); });
    double energy = 0.0;
    tbb::parallel_invoke([&] { energy = contacts_->measure(rods); },
                         [&] {
                           for_each_batch(Work::MUCH, [&](std::size_t batch) {
                             batches_[batch].measure(rods, effects);
                           });
                         });
    searches_.front().tried.add(energy);
  }
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    search_of(lane).tried.add(batches_[batch].merit(lane));
  });
}

/// Accepts where rods were measured. The energy of contacts is not kept: that of friction changes
/// when they are accepted.
void RodGroup::accept(Search& search) {
  search.accepted = Merit{};
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    if (&search_of(lane) == &search) {
      batches_[batch].accept(lane);
      search.accepted.add(batches_[batch].merit(lane));
    }
  });
  if (contacts_ != nullptr) {
    contacts_->accept();
  }
}

void RodGroup::find_step(Rods& rods, const Effects& effects) {
  for_each_batch(Work::MUCH, [&](std::size_t batch) {
    batches_[batch].store_for(effects, rods);
    batches_[batch].assemble(rods, effects);
  });
  if (contacts_ != nullptr) {
    contacts_->add_derivatives(rods, systems_);
  }
  for_each_batch(Work::MUCH,
                 [&](std::size_t batch) { batches_[batch].find_step(part(step_, batch)); });
  if (contacts_ != nullptr) {
    weigh_step();
    if (contacts_->has_coupling()) {
      correct_step();
    }
    limit_step(rods);
  }
  weigh_step();
}

/// How long the step is, and what its slope promises.
void RodGroup::weigh_step() {
  for (Search& search : searches_) {
    search.decrease = search.longest = 0.0;
  }
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    const std::vector<Lanes>& gradient = batches_[batch].gradient();
    const StepWeight weight = weigh(gradient.size(), gradient.data(), part(step_, batch));
    for (std::size_t lane = 0; lane < batches_[batch].used(); ++lane) {
      Search& search = search_of(lane);
      search.decrease += weight.decrease[lane];
      search.longest = std::max(search.longest, weight.longest[lane]);
    }
  }
}

/// Moves rods by a share of the step that brings them lower, or ends their search.
void RodGroup::search_line(Rods& rods, const Effects& effects) {
  // A step must bring at least this part of the decrease that its slope promises (Armijo).
  constexpr double sufficient = 1e-4;
  constexpr int most_halvings = 20;
  for (RodBatch& batch : batches_) {
    batch.remember();
  }
  Merit before_contacts;
  if (contacts_ != nullptr) {
    before_contacts.add(contacts_->energy(rods));  // with the friction of those accepted
  }
  for (Search& search : searches_) {
    search.is_searching = search.is_active;
    search.share = search.is_active ? 1.0 : 0.0;
  }
  const auto is_searching = [](const Search& search) { return search.is_searching; };
  for (int i = 0; i < most_halvings; ++i) {
    move();
    measure(rods, effects);
    for (Search& search : searches_) {
      if (!search.is_searching) {
        continue;
      }
      Merit before = search.accepted;
      before.add(before_contacts);
      const double promised = sufficient * search.share * std::max(0.0, search.decrease);
      if (search.tried.energy <= before.energy - promised + before.unseen()) {
        accept(search);
        search.is_searching = false;
      } else {
        search.share *= 0.5;
      }
    }
    if (std::none_of(searches_.begin(), searches_.end(), is_searching)) {
      return;
    }
  }
  // Nothing is left to gain, or the rods are where no step of this direction helps.
  for (Search& search : searches_) {
    if (search.is_searching) {
      search.share = 0.0;
      search.is_active = false;
    }
  }
  move();
}

/// Moves rods by their shares of the step.
void RodGroup::move() {
  for_each_batch(Work::LITTLE, [&](std::size_t batch) {
    Lanes shares;
    for (std::size_t lane = 0; lane < batches_[batch].used(); ++lane) {
      shares[lane] = search_of(lane).share;
    }
    batches_[batch].move(part(step_, batch), shares);
  });
}

}  // namespace fiber
