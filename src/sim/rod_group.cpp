#include "rod_group.hpp"

#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "lane_sums.hpp"

namespace fiber {

RodGroup::RodGroup(Contacts* contacts) : contacts_(contacts) {}

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
  islands_.resize(batches.size());
  if (contacts_ != nullptr) {
    prepare_coupling(rods);
  }
}

RodGroup::Search& RodGroup::search_of(std::size_t batch, std::size_t lane) {
  return searches_[islands_[batch][lane]];
}

Lanes* RodGroup::part(std::vector<Lanes>& values, std::size_t batch) {
  return values.data() + offsets_[batch];
}

void RodGroup::solve(Rods& rods, const Effects& effects, const StepperOptions& options, double step,
                     Gains gains) {
  for_each_batch(Work::LITTLE,
                 [&](std::size_t batch) { batches_[batch].begin(rods, effects, step); });
  if (contacts_ != nullptr) {
    beginning_ = rods.positions;
    limit_start(rods, effects);
  }
  begin_searches();
  iterate(rods, effects, options);
  if (restart_lost(rods, effects, gains)) {
    iterate(rods, effects, options);
  }
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].finish(rods); });
  if (gains == Gains::TAKEN) {
    take_gains(rods, effects);
  }
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    for (const std::unique_ptr<Effect>& effect : effects) {
      effect->end_solve(rods, batches_[batch].rod(lane));
    }
  });
}

void RodGroup::begin_searches() {
  searches_.assign(contacts_ != nullptr ? systems_.size() : batches_.front().used(), Search{});
  if (contacts_ != nullptr) {
    join_searches();
  } else {
    std::iota(islands_.front().begin(), islands_.front().end(), 0U);
  }
}

/// Newton's method from where the rods are.
void RodGroup::iterate(Rods& rods, const Effects& effects, const StepperOptions& options) {
  const auto is_any_active = [this] {
    return std::any_of(searches_.begin(), searches_.end(),
                       [](const Search& search) { return search.is_active; });
  };
  measure(rods, effects);
  if (contacts_ != nullptr) {
    join_touching();
  }
  for (Search& search : searches_) {
    search.is_accepting = search.is_active;
  }
  accept();
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
    tbb::parallel_invoke([&] { contacts_->measure(rods, contact_energies_); },
                         [&] {
                           for_each_batch(Work::MUCH, [&](std::size_t batch) {
                             batches_[batch].measure(rods, effects);
                           });
                         });
  }
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    Search& search = search_of(batch, lane);
    search.tried.add(batches_[batch].merit(lane));
    if (contacts_ != nullptr) {
      search.tried.add(contact_energies_[batches_[batch].rod(lane)]);
    }
  });
}

/// Accepts where rods of accepting searches were measured. The energy of contacts is not kept: that
/// of friction changes when they are accepted.
void RodGroup::accept() {
  if (std::none_of(searches_.begin(), searches_.end(),
                   [](const Search& search) { return search.is_accepting; })) {
    return;
  }
  for (Search& search : searches_) {
    search.accepted = search.is_accepting ? Merit{} : search.accepted;
  }
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    Search& search = search_of(batch, lane);
    if (search.is_accepting) {
      batches_[batch].accept(lane);
      search.accepted.add(batches_[batch].merit(lane));
    }
    if (contacts_ != nullptr) {
      is_accepting_[batches_[batch].rod(lane)] = search.is_accepting;
    }
  });
  if (contacts_ != nullptr) {
    contacts_->accept(is_accepting_);
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
  stop_inactive();
  if (contacts_ != nullptr) {
    weigh_step();
    if (contacts_->has_coupling()) {
      correct_step();
    }
    limit_step(rods);
  }
  weigh_step();
}

/// What does not search has no step, so that nothing makes room for it.
void RodGroup::stop_inactive() {
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    if (search_of(batch, lane).is_active) {
      return;
    }
    Lanes* const step = part(step_, batch);
    for (std::size_t i = 0; i < batches_[batch].step_size(); ++i) {
      step[i][lane] = 0.0;
    }
  });
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
      Search& search = search_of(batch, lane);
      search.decrease += weight.decrease[lane];
      search.longest = std::max(search.longest, weight.longest[lane]);
    }
  }
}

/// Moves rods by a share of the step that brings them lower, or ends their search.
void RodGroup::search_line(Rods& rods, const Effects& effects) {
  constexpr int most_halvings = 20;
  for (RodBatch& batch : batches_) {
    batch.remember();
  }
  for (Search& search : searches_) {
    search.is_searching = search.is_active;
    search.share = 1.0;
  }
  measure_contacts(rods);
  for (int i = 0; i < most_halvings; ++i) {
    move();
    measure(rods, effects);
    if (!judge_step()) {
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
  if (contacts_ != nullptr) {
    measure(rods, effects);  // others go on, and look at where all are
  }
}

/// Accepts steps that have brought rods lower, and halves the others.
/// @returns whether there are any of these
bool RodGroup::judge_step() {
  // A step must bring at least this part of the decrease that its slope promises (Armijo).
  constexpr double sufficient = 1e-4;
  bool is_any_searching = false;
  for (Search& search : searches_) {
    search.is_accepting = false;
    if (!search.is_searching) {
      continue;
    }
    Merit before = search.accepted;
    before.add(search.contacts);
    const double promised = sufficient * search.share * std::max(0.0, search.decrease);
    search.is_accepting = search.tried.energy <= before.energy - promised + before.unseen();
    search.is_searching = !search.is_accepting;
    search.share *= search.is_searching ? 0.5 : 1.0;
    is_any_searching |= search.is_searching;
  }
  accept();
  return is_any_searching;
}

/// Moves rods by their shares of the step.
void RodGroup::move() {
  for_each_batch(Work::LITTLE, [&](std::size_t batch) {
    Lanes shares;
    for (std::size_t lane = 0; lane < batches_[batch].used(); ++lane) {
      shares[lane] = search_of(batch, lane).share;
    }
    batches_[batch].move(part(step_, batch), shares);
  });
}

}  // namespace fiber
