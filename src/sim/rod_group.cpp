#include "rod_group.hpp"

#include <tbb/blocked_range.h>
#include <tbb/parallel_for.h>
#include <tbb/parallel_invoke.h>

#include <algorithm>
#include <cmath>

#include "lane_sums.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

using Numbers = Eigen::Map<Eigen::VectorXd>;

Numbers numbers(std::vector<Lanes>& values) {
  return {values.data()->of.data(), static_cast<Eigen::Index>(values.size() * lane_count)};
}

}  // namespace

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

void RodGroup::prepare_coupling(const Rods& rods) {
  for (auto* array : {&gradients_.residual, &gradients_.preconditioned, &gradients_.direction,
                      &gradients_.product, &gradients_.image}) {
    array->resize(step_.size());
  }
  systems_.resize(rods.count());
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

/// In parallel, but little work only if there are many: one of them is done before another thread
/// has heard of it.
template <typename Function>
void RodGroup::for_each_batch(Work work, const Function& function) {
  const std::size_t together = work == Work::MUCH ? 1 : 16;
  tbb::parallel_for(tbb::blocked_range<std::size_t>(0, batches_.size(), together),
                    [&](const tbb::blocked_range<std::size_t>& range) {
                      for (std::size_t batch = range.begin(); batch < range.end(); ++batch) {
                        function(batch);
                      }
                    });
}

/// One after the other.
template <typename Function>
void RodGroup::for_each_rod(const Function& function) {
  for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
    for (std::size_t lane = 0; lane < batches_[batch].used(); ++lane) {
      function(batch, lane);
    }
  }
}

/// Without contacts there is one batch.
RodGroup::Search& RodGroup::search_of(std::size_t lane) {
  return searches_[contacts_ != nullptr ? 0 : lane];
}

Lanes* RodGroup::part(std::vector<Lanes>& values, std::size_t batch) {
  return values.data() + offsets_[batch];
}

void RodGroup::solve(Rods& rods, const Effects& effects, const StepperOptions& options,
                     double step) {
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
  if (restart_lost(rods, effects)) {
    iterate(rods, effects, options);
  }
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].finish(rods); });
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    for (const std::unique_ptr<Effect>& effect : effects) {
      effect->end_solve(rods, batches_[batch].rod(lane));
    }
  });
}

/// Finds rods that inertia has thrown where few iterations do not lead back from, as it does with
/// something stiff, and brings them where they keep their shapes: that is nearer to what they do.
/// So it does with those that end with more energy than they had, which contacts alone may bring.
/// @returns true if there are any; their searches are active then
bool RodGroup::restart_lost(Rods& rods, const Effects& effects) {
  for_each_batch(Work::MUCH, [&](std::size_t index) {
    RodBatch& batch = batches_[index];
    std::array<double, lane_count> found{};
    for (std::size_t lane = 0; lane < batch.used(); ++lane) {
      found[lane] = batch.accepted(lane).energy;
    }
    const Lanes found_total = batch.energy_at_end();
    batch.remember();
    batch.carry();
    batch.store_for(effects, rods);
    batch.measure(rods, effects);
    const Lanes carried_total = batch.energy_with_old_velocity();
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const Merit& carried = batch.merit(lane);
      const double gained = found_total[lane] - carried_total[lane];
      is_found_[index][lane] = found[lane] <= carried.energy + carried.unseen() &&
                               (contacts_ != nullptr || gained <= carried.unseen());
    }
    batch.restore(is_found_[index]);
  });
  for (Search& search : searches_) {
    search.is_active = false;
  }
  bool is_any_lost = false;
  for_each_rod([&](std::size_t batch, std::size_t lane) {
    search_of(lane).is_active |= !is_found_[batch][lane];
    is_any_lost |= !is_found_[batch][lane];
  });
  if (is_any_lost && contacts_ != nullptr) {
    for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].store(rods); });
    wanted_ = rods.positions;
    rods.positions = beginning_;
    contacts_->measure(rods);
    rods.positions = wanted_;
    limit_start(rods, effects);
  }
  return is_any_lost;
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

/// From where the contacts were measured, the beginning: neither inertia nor what holds a rod may
/// carry it through another on its way from where it began.
void RodGroup::limit_start(Rods& rods, const Effects& effects) {
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].store(rods); });
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] = rods.positions[i] - beginning_[i];
  }
  rods.positions = beginning_;
  wanted_ = displacements_;
  contacts_->limit(rods, displacements_);
  for_each_batch(Work::MUCH, [&](std::size_t batch) { stop_torn(rods, effects, batch); });
  rods.positions = beginning_;
  // What stays may be in the way of what follows it.
  contacts_->limit(rods, displacements_);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    rods.positions[i] += displacements_[i];
  }
  for_each_batch(Work::LITTLE, [&](std::size_t batch) { batches_[batch].place(rods.positions); });
}

/// Where limits have stopped nodes of a rod so that their neighbours are torn from them, only what
/// is held moves: the rod has no more energy than it began with.
void RodGroup::stop_torn(Rods& rods, const Effects& effects, std::size_t index) {
  RodBatch& batch = batches_[index];
  LaneFlags is_limited{};
  for (std::size_t lane = 0; lane < batch.used(); ++lane) {
    const auto first = static_cast<std::ptrdiff_t>(rods.first(batch.rod(lane)));
    const auto end = static_cast<std::ptrdiff_t>(rods.end(batch.rod(lane)));
    is_limited[lane] =
        !std::equal(wanted_.begin() + first, wanted_.begin() + end, displacements_.begin() + first);
  }
  if (std::none_of(is_limited.begin(), is_limited.end(), [](bool is) { return is; })) {
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
    if (is_limited[lane] && limited[lane] > at_rest[lane]) {
      const std::uint32_t rod = batch.rod(lane);
      std::copy(stopped.begin() + rods.first(rod), stopped.begin() + rods.end(rod),
                displacements_.begin() + rods.first(rod));
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

/// Conjugate gradients for what joins rods, from the step without it, with the factors of the rods
/// as preconditioner. The Hessian's product with a direction p needs no Hessian: with the
/// preconditioner M, M p follows from the residuals p is made of.
void RodGroup::correct_step() {
  constexpr int most_iterations = 100;
  constexpr double tolerance = 1e-3;  // of the residual, in the preconditioner's norm
  const auto add_coupling = [this](const Numbers& values, Numbers& product) {
    contacts_->add_coupling(places_, values.data(), product.data());
  };
  // Few rods are solved for sooner than threads are told to.
  const auto precondition = [this](std::vector<Lanes>& values) {
    for (std::size_t batch = 0; batch < batches_.size(); ++batch) {
      batches_[batch].solve(part(values, batch));
    }
  };
  Numbers step = numbers(step_);
  Numbers residual = numbers(gradients_.residual);
  Numbers preconditioned = numbers(gradients_.preconditioned);
  Numbers direction = numbers(gradients_.direction);
  Numbers product = numbers(gradients_.product);
  Numbers image = numbers(gradients_.image);
  image = -step;
  residual.setZero();
  add_coupling(image, residual);
  direction = residual;
  precondition(gradients_.direction);
  product = residual;
  double norm = residual.dot(direction);
  const double small = tolerance * tolerance * searches_.front().decrease;
  for (int i = 0; i < most_iterations && norm > small; ++i) {
    image = product;
    add_coupling(direction, image);
    const double curvature = direction.dot(image);
    if (!(curvature > 0.0 && std::isfinite(curvature))) {
      break;
    }
    const double share = norm / curvature;
    step += share * direction;
    residual -= share * image;
    preconditioned = residual;
    precondition(gradients_.preconditioned);
    const double next_norm = residual.dot(preconditioned);
    direction = preconditioned + next_norm / norm * direction;
    product = residual + next_norm / norm * product;
    norm = next_norm;
  }
}

void RodGroup::limit_step(const Rods& rods) {
  using Stride = Eigen::InnerStride<lane_count>;
  double* const step = numbers(step_).data();
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    displacements_[i] = Eigen::Map<const Vector3d, 0, Stride>(step + places_[i]);
  }
  contacts_->limit(rods, displacements_);
  for (std::size_t i = 0; i < displacements_.size(); ++i) {
    Eigen::Map<Vector3d, 0, Stride>(step + places_[i]) = displacements_[i];
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
