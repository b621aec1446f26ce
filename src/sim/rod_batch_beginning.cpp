// How a batch of rods begins: which they are, where, and what holds them.

#include <algorithm>

#include "rod_batch.hpp"

namespace fiber {

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
  measure_edges(lanes_);
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

}  // namespace fiber
