#include "rod_batch.hpp"

#include <algorithm>

#include "lane_sums.hpp"

namespace fiber {

using Eigen::Vector3d;

void RodBatch::assign(const Rods& rods, const std::vector<std::uint32_t>& members) {
  lanes_.used = members.size();
  lanes_.node_count = rods.node_count(members.front());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    lanes_.rods[lane] = members[lane < members.size() ? lane : 0];
    first_nodes_[lane] = rods.first(lanes_.rods[lane]);
  }
  lanes_.unknowns = rods.angles.empty() ? 3 : 4;
  system_.resize(lanes_.node_count, lanes_.unknowns);
  const std::size_t nodes = lanes_.node_count;
  for (auto* array : {&lanes_.masses, &lanes_.rest_lengths, &lanes_.inverse_rest_lengths,
                      &lanes_.inverse_node_lengths, &lanes_.lengths, &lanes_.inverse_lengths}) {
    array->resize(nodes);
  }
  lanes_.tangents.resize(3 * nodes);
  if (system_.unknowns == 4) {
    for (auto* array : {&lanes_.start_directors, &lanes_.start_tangents, &lanes_.directors}) {
      array->resize(3 * nodes);
    }
    lanes_.director_twists.resize(nodes);
  }
  for (auto* array : {&lanes_.positions, &inertias_, &beginning_, &predicted_, &remembered_}) {
    array->resize(system_.size());
  }
  views_.clear();
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    views_.emplace_back(system_, lane);
  }
  held_.resize(lane_count);
}

void RodBatch::begin(const Rods& rods, const Effects& effects, double step) {
  step_length_ = step;
  load(rods);
  load_values(effects);
  hold(rods);
  lanes_.positions = predicted_;
  has_moved();
}

void RodBatch::load(const Rods& rods) {
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t first = first_nodes_[lane];
    load_inertias(rods, lane);
    for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
      const std::size_t place = i * unknowns;
      for (std::uint32_t k = 0; k < 3; ++k) {
        beginning_[place + k][lane] = rods.positions[first + i][k];
        predicted_[place + k][lane] =
            rods.positions[first + i][k] + step_length_ * rods.velocities[first + i][k];
      }
      if (unknowns == 4) {
        beginning_[place + 3][lane] = rods.angles[first + i];
        predicted_[place + 3][lane] = rods.angles[first + i] + step_length_ * rods.spins[first + i];
        for (std::uint32_t k = 0; k < 3; ++k) {
          lanes_.start_directors[3 * i + k][lane] = rods.directors[first + i][k];
          lanes_.start_tangents[3 * i + k][lane] = rods.start_tangents[first + i][k];
        }
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

void RodBatch::load_inertias(const Rods& rods, std::size_t lane) {
  const std::size_t unknowns = system_.unknowns;
  const std::uint32_t first = first_nodes_[lane];
  const RodSection& section = rods.sections[lanes_.rods[lane]];
  lanes_.stretching_stiffness[lane] = section.stretching_stiffness;
  lanes_.bending_stiffness[lane] = section.bending_stiffness;
  lanes_.twisting_stiffness[lane] = section.twisting_stiffness;
  for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
    lanes_.masses[i][lane] = rods.masses[first + i];
    lanes_.rest_lengths[i][lane] = rods.rest_lengths[first + i];
    for (std::uint32_t k = 0; k < 3; ++k) {
      inertias_[i * unknowns + k][lane] = rods.masses[first + i];
    }
    if (unknowns == 4) {
      // After the last node there is no edge: its angle stays as it is.
      const double length = i + 1 < lanes_.node_count ? rods.rest_lengths[first + i] : 1.0;
      inertias_[i * unknowns + 3][lane] = section.inertia_per_length * length;
    }
  }
}

void RodBatch::load_values(const Effects& effects) {
  values_.resize(effects.size());
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const std::size_t count = effects[e]->values_per_node();
    values_[e].resize(count * lanes_.node_count);
    if (count == 0) {
      continue;
    }
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::uint32_t first = first_nodes_[lane];
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
    const std::uint32_t first = first_nodes_[lane];
    auto held = std::lower_bound(rods.held.begin(), rods.held.end(), first, is_before);
    for (; held != rods.held.end() && held->node < first + lanes_.node_count; ++held) {
      const std::uint32_t node = held->node - first;
      held_[lane].push_back(node);
      for (std::uint32_t k = 0; k < 3; ++k) {
        predicted_[node * system_.unknowns + k][lane] = held->position[k];
      }
    }
  }
}

void RodBatch::has_moved() { measure_edges(lanes_); }

void RodBatch::place(const std::vector<Vector3d>& positions) {
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    const Vector3d* const first = &positions[first_nodes_[lane]];
    for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        lanes_.positions[i * unknowns + k][lane] = first[i][k];
      }
    }
  }
  has_moved();
}

void RodBatch::carry() {
  const std::size_t unknowns = system_.unknowns;
  lanes_.positions = beginning_;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    if (held_[lane].empty()) {
      double mass = 0.0;
      Vector3d drift = Vector3d::Zero();
      for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
        mass += lanes_.masses[i][lane];
        for (std::uint32_t k = 0; k < 3; ++k) {
          const std::size_t place = i * unknowns + k;
          drift[k] += lanes_.masses[i][lane] * (predicted_[place][lane] - beginning_[place][lane]);
        }
      }
      for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
        for (std::uint32_t k = 0; k < 3; ++k) {
          lanes_.positions[i * unknowns + k][lane] += drift[k] / mass;
        }
      }
    }
    for (const std::uint32_t node : held_[lane]) {
      for (std::size_t place = node * unknowns, end = place + 3; place < end; ++place) {
        lanes_.positions[place][lane] = predicted_[place][lane];
      }
    }
  }
  has_moved();
}

void RodBatch::restore(const LaneFlags& which) {
  for (std::size_t i = 0; i < system_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      lanes_.positions[i][lane] = which[lane] ? remembered_[i][lane] : lanes_.positions[i][lane];
    }
  }
  has_moved();
}

void RodBatch::move(const Lanes* step, const Lanes& shares) {
  move_by(system_.size(), remembered_.data(), step, shares, lanes_.positions.data());
  has_moved();
}

void RodBatch::store(Rods& rods) const {
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    const std::uint32_t first = first_nodes_[lane];
    for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
      const std::size_t place = i * unknowns;
      for (std::uint32_t k = 0; k < 3; ++k) {
        rods.positions[first + i][k] = lanes_.positions[place + k][lane];
      }
      if (unknowns == 4) {
        rods.angles[first + i] = lanes_.positions[place + 3][lane];
      }
    }
  }
}

void RodBatch::store_for(const Effects& effects, Rods& rods) const {
  const auto needs_it = [&](const std::unique_ptr<Effect>& effect) {
    return !effect->works_in_lanes(rods);
  };
  if (std::any_of(effects.begin(), effects.end(), needs_it)) {
    store(rods);
  }
}

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

void RodBatch::assemble(const Rods& rods, const Effects& effects) {
  const double inverse_square = 1.0 / (step_length_ * step_length_);
  const std::size_t height = half_bandwidth(system_.unknowns) + 1;
  system_.set_zero();
  set_inertia(system_.size(), inverse_square, inertias_.data(), lanes_.positions.data(),
              predicted_.data(), system_.gradient.data(), system_.hessian.data(), height);
  for (std::size_t e = 0; e < effects.size(); ++e) {
    if (effects[e]->works_in_lanes(rods)) {
      effects[e]->add_derivatives_in_lanes(lanes_, values_[e], system_);
      continue;
    }
    for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
      effects[e]->add_derivatives(rods, lanes_.rods[lane], views_[lane]);
    }
  }
}

void RodBatch::find_step(Lanes* step) {
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    for (const std::uint32_t node : held_[lane]) {
      views_[lane].hold(node);
    }
  }
  // All effects add positive semidefinite blocks, and masses are positive: only rounding errors can
  // make it indefinite, and what it solves for then still lets the energy fall.
  factorise_band(system_);
  for (std::size_t i = 0; i < system_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      step[i][lane] = -system_.gradient[i][lane];
    }
  }
  std::fill(step + system_.size(), step + step_size(), Lanes{});
  solve(step);
  keep_finite(step);
}

/// Where edges have shrunk to nothing, as without stretch they may, stiffnesses are beyond what
/// numbers can hold: such a rod has no step.
void RodBatch::keep_finite(Lanes* step) const {
  Lanes zero;
  for (std::size_t i = 0; i < system_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      zero[lane] += 0.0 * step[i][lane];
    }
  }
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    if (zero[lane] == 0.0) {
      continue;
    }
    for (std::size_t i = 0; i < system_.size(); ++i) {
      step[i][lane] = 0.0;
    }
  }
}

void RodBatch::finish(Rods& rods) const {
  store(rods);
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    const std::uint32_t first = first_nodes_[lane];
    const auto rate = [&](std::size_t place) {
      return (lanes_.positions[place][lane] - beginning_[place][lane]) / step_length_;
    };
    for (std::uint32_t i = 0; i < lanes_.node_count; ++i) {
      const std::size_t place = i * unknowns;
      rods.velocities[first + i] = {rate(place), rate(place + 1), rate(place + 2)};
      if (unknowns == 4) {
        rods.spins[first + i] = rate(place + 3);
      }
    }
  }
}

}  // namespace fiber
