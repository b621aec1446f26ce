#include "rod_batch.hpp"

#include <algorithm>
#include <cmath>

#include "lane_solver.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

constexpr std::size_t width = BandMatrix::without_twist;

}  // namespace

RodBatch::RodBatch(const Rods& rods, const std::vector<std::uint32_t>& members)
    : held_(members.size()) {
  lanes_.used = members.size();
  lanes_.node_count = rods.node_count(members.front());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    lanes_.rods[lane] = members[lane < members.size() ? lane : 0];
  }
  const std::size_t nodes = lanes_.node_count;
  for (auto* array : {&lanes_.masses, &lanes_.rest_lengths, &lanes_.inverse_rest_lengths,
                      &lanes_.inverse_node_lengths, &lanes_.lengths, &lanes_.inverse_lengths}) {
    array->resize(nodes);
  }
  for (auto* array : {&lanes_.positions, &lanes_.tangents, &beginning_, &predicted_, &iterate_,
                      &system_.gradient}) {
    array->resize(3 * nodes);
  }
  step_.resize(3 * nodes + width);
  system_.hessian.resize(step_.size() * (width + 1));
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    views_.emplace_back(system_, lane);
  }
}

void RodBatch::load(const Rods& rods) {
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t rod = lanes_.rods[lane];
    const std::uint32_t first = rods.first(rod);
    lanes_.stretching_stiffness[lane] = rods.sections[rod].stretching_stiffness;
    lanes_.bending_stiffness[lane] = rods.sections[rod].bending_stiffness;
    for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
      lanes_.masses[i][lane] = rods.masses[first + i];
      lanes_.rest_lengths[i][lane] = rods.rest_lengths[first + i];
      for (std::uint32_t k = 0; k < 3; ++k) {
        beginning_[3 * i + k][lane] = rods.positions[first + i][k];
        predicted_[3 * i + k][lane] =
            rods.positions[first + i][k] + step_length_ * rods.velocities[first + i][k];
      }
    }
  }
  for (std::uint32_t i = 0; i + 1 < lanes_.node_count; ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const double length = lanes_.rest_lengths[i][lane];
      const double before = i > 0 ? lanes_.rest_lengths[i - 1][lane] : length;
      lanes_.inverse_rest_lengths[i][lane] = 1.0 / length;
      lanes_.inverse_node_lengths[i][lane] = 2.0 / (before + length);
    }
  }
}

void RodBatch::load_values(const Rods& rods, const Effects& effects) {
  values_.resize(effects.size());
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const std::size_t count = effects[e]->values_per_node();
    values_[e].resize(count * lanes_.node_count);
    if (count == 0) {
      continue;
    }
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::uint32_t first = rods.first(lanes_.rods[lane]);
      for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
        const double* const values = effects[e]->values_of(first + i);
        for (std::size_t k = 0; k < count; ++k) {
          values_[e][count * i + k][lane] = values[k];
        }
      }
    }
  }
}

/// Puts what is held where it is to be.
void RodBatch::hold(const Rods& rods) {
  const auto is_before = [](const HeldNode& held, std::uint32_t node) { return held.node < node; };
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    held_[lane].clear();
    const std::uint32_t first = rods.first(lanes_.rods[lane]);
    auto held = std::lower_bound(rods.held.begin(), rods.held.end(), first, is_before);
    for (; held != rods.held.end() && held->node < first + lanes_.node_count; ++held) {
      const std::uint32_t node = held->node - first;
      held_[lane].push_back(node);
      for (std::uint32_t k = 0; k < 3; ++k) {
        predicted_[3 * node + k][lane] = held->position[k];
      }
    }
  }
}

void RodBatch::solve(Rods& rods, const Effects& effects, const StepperOptions& options,
                     double step) {
  step_length_ = step;
  load(rods);
  load_values(rods, effects);
  hold(rods);
  lanes_.positions = predicted_;
  Flags used{};
  std::fill_n(used.begin(), lanes_.used, true);
  measure(rods, effects);
  accepted_merits_ = merits_;
  iterate(rods, effects, options, used);

  // As in RodGroup::find_lost().
  iterate_ = lanes_.positions;
  carry();
  measure(rods, effects);
  Flags is_lost{};
  bool is_any_lost = false;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    const Merit& carried = merits_[lane];
    is_lost[lane] = accepted_merits_[lane].energy > carried.energy + carried.unseen();
    is_any_lost |= is_lost[lane];
    if (is_lost[lane]) {
      accepted_merits_[lane] = carried;
    }
  }
  for (std::size_t i = 0; i < iterate_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      lanes_.positions[i][lane] = is_lost[lane] ? lanes_.positions[i][lane] : iterate_[i][lane];
    }
  }
  if (is_any_lost) {
    measure_edges(lanes_);
    iterate(rods, effects, options, is_lost);
  }
  finish(rods);
}

/// As MovingRod::carry().
void RodBatch::carry() {
  lanes_.positions = beginning_;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    if (held_[lane].empty()) {
      double mass = 0.0;
      Vector3d drift = Vector3d::Zero();
      for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
        mass += lanes_.masses[i][lane];
        for (std::uint32_t k = 0; k < 3; ++k) {
          drift[k] +=
              lanes_.masses[i][lane] * (predicted_[3 * i + k][lane] - beginning_[3 * i + k][lane]);
        }
      }
      for (std::uint32_t i = 0; i < 3 * lanes_.node_count; ++i) {
        lanes_.positions[i][lane] += drift[i % 3] / mass;
      }
    }
    for (const std::uint32_t node : held_[lane]) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        lanes_.positions[3 * node + k][lane] = predicted_[3 * node + k][lane];
      }
    }
  }
}

/// The merits of where the rods are now.
void RodBatch::measure(Rods& rods, const Effects& effects) {
  measure_edges(lanes_);
  Lanes kinetic;
  for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      double square = 0.0;
      for (std::uint32_t k = 0; k < 3; ++k) {
        const double change = lanes_.positions[3 * i + k][lane] - predicted_[3 * i + k][lane];
        square += change * change;
      }
      kinetic[lane] += lanes_.masses[i][lane] * square;
    }
  }
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    merits_[lane] = Merit{};
    merits_[lane].add(0.5 * kinetic[lane] / (step_length_ * step_length_));
  }
  bool is_stored = false;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const std::unique_ptr<Effect>& effect = effects[e];
    Lanes energy;
    if (effect->works_in_lanes(rods)) {
      effect->energy_in_lanes(lanes_, values_[e], energy);
    } else {
      if (!is_stored) {
        store_positions(rods);
        is_stored = true;
      }
      for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
        energy[lane] = effect->energy(rods, lanes_.rods[lane]);
      }
    }
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      merits_[lane].add(energy[lane]);
    }
  }
}

void RodBatch::store_positions(Rods& rods) const {
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    const std::uint32_t first = rods.first(lanes_.rods[lane]);
    for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        rods.positions[first + i][k] = lanes_.positions[3 * i + k][lane];
      }
    }
  }
}

/// Newton's method from where the rods are, which has been measured and accepted, for the active
/// ones.
void RodBatch::iterate(Rods& rods, const Effects& effects, const StepperOptions& options,
                       Flags active) {
  const auto is_any = [](const Flags& flags) {
    return std::find(flags.begin(), flags.end(), true) != flags.end();
  };
  for (std::uint32_t i = 0; i < options.iterations && is_any(active); ++i) {
    find_step(rods, effects);
    Lanes longest;
    for (std::size_t row = 0; row < 3 * std::size_t{lanes_.node_count}; ++row) {
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        longest[lane] = std::max(longest[lane], std::abs(step_[row][lane]));
      }
    }
    active = search(rods, effects, active);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      active[lane] = active[lane] && !(longest[lane] < options.tolerance);
    }
  }
}

void RodBatch::find_step(const Rods& rods, const Effects& effects) {
  const double inverse_square = 1.0 / (step_length_ * step_length_);
  std::fill(system_.hessian.begin(), system_.hessian.end(), Lanes{});
  for (std::uint32_t i = 0; i < 3 * lanes_.node_count; ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const double inertia = lanes_.masses[i / 3][lane] * inverse_square;
      system_.gradient[i][lane] = inertia * (lanes_.positions[i][lane] - predicted_[i][lane]);
      system_.hessian[i * (width + 1)][lane] = inertia;
    }
  }
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const std::unique_ptr<Effect>& effect = effects[e];
    if (effect->works_in_lanes(rods)) {
      effect->add_derivatives_in_lanes(lanes_, values_[e], system_);
      continue;
    }
    for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
      effect->add_derivatives(rods, lanes_.rods[lane], views_[lane]);
    }
  }
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    for (const std::uint32_t node : held_[lane]) {
      views_[lane].hold(node);
    }
  }
  const std::size_t size = system_.gradient.size();
  factorise_lanes(size, system_.hessian);
  for (std::size_t i = 0; i < size; ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      step_[i][lane] = -system_.gradient[i][lane];
    }
  }
  std::fill(step_.begin() + static_cast<std::ptrdiff_t>(size), step_.end(), Lanes{});
  solve_lanes(size, system_.hessian, step_);
}

/// As RodGroup::search().
/// @returns which of the active rods have found something better
RodBatch::Flags RodBatch::search(Rods& rods, const Effects& effects, const Flags& active) {
  constexpr double sufficient = 1e-4;
  constexpr int most_halvings = 20;
  Lanes decrease;
  for (std::size_t i = 0; i < system_.gradient.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      decrease[lane] -= system_.gradient[i][lane] * step_[i][lane];
    }
  }
  iterate_.swap(lanes_.positions);
  Flags is_searching = active;
  Lanes shares;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    shares[lane] = active[lane] ? 1.0 : 0.0;
  }
  for (int i = 0; i < most_halvings; ++i) {
    move(shares);
    measure(rods, effects);
    bool is_settled = true;
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      if (!is_searching[lane]) {
        continue;
      }
      const Merit& before = accepted_merits_[lane];
      const double wanted = before.energy + before.unseen() -
                            sufficient * shares[lane] * std::max(0.0, decrease[lane]);
      if (merits_[lane].energy <= wanted) {
        accepted_merits_[lane] = merits_[lane];
        is_searching[lane] = false;
      } else {
        shares[lane] *= 0.5;
        is_settled = false;
      }
    }
    if (is_settled) {
      return active;
    }
  }
  Flags has_found = active;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (is_searching[lane]) {
      has_found[lane] = false;
      shares[lane] = 0.0;
    }
  }
  move(shares);
  measure(rods, effects);
  return has_found;
}

void RodBatch::move(const Lanes& shares) {
  for (std::size_t i = 0; i < iterate_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const double way = shares[lane] > 0.0 ? shares[lane] * step_[i][lane] : 0.0;
      lanes_.positions[i][lane] = iterate_[i][lane] + way;
    }
  }
}

void RodBatch::finish(Rods& rods) const {
  store_positions(rods);
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    const std::uint32_t first = rods.first(lanes_.rods[lane]);
    for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        rods.velocities[first + i][k] =
            (lanes_.positions[3 * i + k][lane] - beginning_[3 * i + k][lane]) / step_length_;
      }
    }
  }
}

}  // namespace fiber
