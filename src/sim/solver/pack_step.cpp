#include "src/sim/solver/pack_step.hpp"

#include <algorithm>

#include "src/sim/solver/band_solver.hpp"
#include "src/sim/solver/pack_sums.hpp"

namespace fiber {

void PackStep::assign(const Rods& rods, const std::vector<std::uint32_t>& members) {
  pack_.used = members.size();
  pack_.node_count = rods.node_count(members.front());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    pack_.rods[lane] = members[lane < members.size() ? lane : 0];
    pack_.first_nodes[lane] = rods.first(pack_.rods[lane]);
  }
  pack_.unknowns = rods.angles.empty() ? 3 : 4;
  system_.resize(pack_.node_count, pack_.unknowns, pack_.used);
  const std::size_t nodes = pack_.node_count;
  for (auto* array :
       {&pack_.masses, &pack_.rest_lengths, &pack_.inverse_rest_lengths,
        &pack_.inverse_node_lengths, &pack_.lengths, &pack_.inverse_lengths, &residuals_}) {
    array->resize(nodes);
  }
  pack_.tangents.resize(3 * nodes);
  if (system_.unknowns == 4) {
    for (auto* array : {&pack_.start_directors, &pack_.start_tangents, &pack_.directors}) {
      array->resize(3 * nodes);
    }
    pack_.director_twists.resize(nodes);
  }
  for (auto* array :
       {&pack_.positions, &inertias_, &scales_, &beginning_, &predicted_, &remembered_}) {
    array->resize(system_.size());
  }
  views_.clear();
  for (std::size_t lane = 0; lane < pack_.used; ++lane) {
    views_.emplace_back(system_, lane);
  }
}

void PackStep::begin(const Rods& rods, const Effects& effects, double step) {
  step_length_ = step;
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    load_constants(rods, lane);
    const std::uint32_t first = pack_.first_nodes[lane];
    for (std::uint32_t i = 0; i < pack_.node_count; ++i) {
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
          pack_.start_directors[3 * i + k][lane] = rods.directors[first + i][k];
          pack_.start_tangents[3 * i + k][lane] = rods.start_tangents[first + i][k];
        }
      }
    }
  }
  load_values(effects);
  pack_.positions = beginning_;
  measure_edges(pack_);
}

void PackStep::load_constants(const Rods& rods, std::size_t lane) {
  const std::size_t unknowns = system_.unknowns;
  const std::uint32_t first = pack_.first_nodes[lane];
  const std::uint32_t rod = pack_.rods[lane];
  const RodSection& section = rods.sections[rod];
  pack_.stretching_stiffness[lane] = section.stretching_stiffness;
  pack_.bending_stiffness[lane] = section.bending_stiffness;
  pack_.twisting_stiffness[lane] = section.twisting_stiffness;
  for (std::uint32_t i = 0; i < pack_.node_count; ++i) {
    const double length = rods.rest_lengths[first + i];
    pack_.masses[i][lane] = rods.masses[first + i];
    pack_.rest_lengths[i][lane] = length;
    for (std::size_t k = 0; k < 3; ++k) {
      inertias_[i * unknowns + k][lane] = rods.masses[first + i];
      scales_[i * unknowns + k][lane] = step_length_ / rods.masses[first + i];
    }
    const bool has_edge = i + 1 < pack_.node_count;
    if (unknowns == 4) {
      // After the last node there is no edge: its angle stays as it is.
      const double inertia = section.inertia_per_length * (has_edge ? length : 1.0);
      inertias_[i * unknowns + 3][lane] = inertia;
      scales_[i * unknowns + 3][lane] = rods.radii[rod] * step_length_ / inertia;
    }
    if (has_edge) {
      const double before = i > 0 ? rods.rest_lengths[first + i - 1] : length;
      pack_.inverse_rest_lengths[i][lane] = 1.0 / length;
      pack_.inverse_node_lengths[i][lane] = 2.0 / (before + length);
    }
  }
}

void PackStep::load_values(const Effects& effects) {
  values_.resize(effects.size());
  for (std::size_t e = 0; e < effects.size(); ++e) {
    const std::size_t count = effects[e]->values_per_node();
    values_[e].resize(count * pack_.node_count);
    if (count == 0) {
      continue;
    }
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      const std::uint32_t first = pack_.first_nodes[lane];
      for (std::uint32_t i = 0; i < pack_.node_count; ++i) {
        const double* const values = effects[e]->values_of(first + i);
        for (std::size_t k = 0; k < count; ++k) {
          values_[e][count * i + k][lane] = values[k];
        }
      }
    }
  }
}

void PackStep::load(const Rods& rods) {
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    const std::uint32_t first = pack_.first_nodes[lane];
    for (std::uint32_t i = 0; i < pack_.node_count; ++i) {
      const std::size_t place = i * unknowns;
      for (std::uint32_t k = 0; k < 3; ++k) {
        pack_.positions[place + k][lane] = rods.positions[first + i][k];
      }
      if (unknowns == 4) {
        pack_.positions[place + 3][lane] = rods.angles[first + i];
      }
    }
  }
  measure_edges(pack_);
}

void PackStep::store(Rods& rods) const {
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < pack_.used; ++lane) {
    const std::uint32_t first = pack_.first_nodes[lane];
    for (std::uint32_t i = 0; i < pack_.node_count; ++i) {
      const std::size_t place = i * unknowns;
      for (std::uint32_t k = 0; k < 3; ++k) {
        rods.positions[first + i][k] = pack_.positions[place + k][lane];
      }
      if (unknowns == 4) {
        rods.angles[first + i] = pack_.positions[place + 3][lane];
      }
    }
  }
}

void PackStep::predict(SimdBatch* step) const {
  for (std::size_t i = 0; i < system_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      step[i][lane] = predicted_[i][lane] - pack_.positions[i][lane];
    }
  }
  std::fill(step + system_.size(), step + step_size(), SimdBatch{});
}

void PackStep::move(const SimdBatch* step, const SimdBatch& shares) {
  move_by({system_.size(), pack_.used}, remembered_.data(), step, shares, pack_.positions.data());
  measure_edges(pack_);
}

void PackStep::measure(const Effects& effects) {
  const SimdBatch kinetic = weighted_squares({system_.size(), pack_.used}, inertias_.data(),
                                             pack_.positions.data(), predicted_.data());
  for (std::size_t lane = 0; lane < lane_count; ++lane) {
    energies_[lane] = EnergySum{};
    energies_[lane].add(0.5 * kinetic[lane] / (step_length_ * step_length_));
  }
  stored_ = 0.0;
  for (std::size_t e = 0; e < effects.size(); ++e) {
    SimdBatch energy;
    effects[e]->energy(pack_, values_[e], energy);
    const bool is_stored = effects[e]->is_stored();
    for (std::size_t lane = 0; lane < pack_.used; ++lane) {
      energies_[lane].add(energy[lane]);
      stored_ += is_stored ? energy[lane] : 0.0;
    }
  }
}

void PackStep::assemble(const Effects& effects) {
  const double inverse_square = 1.0 / (step_length_ * step_length_);
  const std::size_t height = half_bandwidth(system_.unknowns) + 1;
  system_.set_zero();
  set_inertia({system_.size(), pack_.used}, inverse_square, inertias_.data(),
              pack_.positions.data(), predicted_.data(), system_.gradient.data(),
              system_.hessian.data(), height);
  for (std::size_t e = 0; e < effects.size(); ++e) {
    effects[e]->add_derivatives(pack_, values_[e], system_);
  }
}

void PackStep::measure_residuals() {
  squared_residuals({pack_.node_count, pack_.used}, system_.unknowns, system_.gradient.data(),
                    scales_.data(), residuals_.data());
}

PackStep::Residual PackStep::residual(std::size_t lane) const {
  std::uint32_t worst = 0;
  for (std::uint32_t i = 1; i < pack_.node_count; ++i) {
    worst = residuals_[i][lane] > residuals_[worst][lane] ? i : worst;
  }
  return {std::sqrt(residuals_[worst][lane]), worst};
}

void PackStep::find_step(SimdBatch* step) {
  // All effects add positive semidefinite blocks, and masses are positive: only rounding errors can
  // make it indefinite, and what it solves for then still lets the energy fall.
  factorise_band(system_);
  for (std::size_t i = 0; i < system_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      step[i][lane] = -system_.gradient[i][lane];
    }
  }
  std::fill(step + system_.size(), step + step_size(), SimdBatch{});
  solve(step);
  keep_finite(step);
}

void PackStep::solve(SimdBatch* values) const { solve_band(system_, values); }

/// Where edges have shrunk to nothing, as without stretch they may, stiffnesses are beyond what
/// numbers can hold: such a rod has no step.
void PackStep::keep_finite(SimdBatch* step) const {
  SimdBatch zero;
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

void PackStep::finish(Rods& rods) const {
  store(rods);
  const std::size_t unknowns = system_.unknowns;
  for (std::size_t lane = 0; lane < pack_.used; ++lane) {
    const std::uint32_t first = pack_.first_nodes[lane];
    const auto rate = [&](std::size_t place) {
      return (pack_.positions[place][lane] - beginning_[place][lane]) / step_length_;
    };
    for (std::uint32_t i = 0; i < pack_.node_count; ++i) {
      const std::size_t place = i * unknowns;
      rods.velocities[first + i] = {rate(place), rate(place + 1), rate(place + 2)};
      if (unknowns == 4) {
        rods.spins[first + i] = rate(place + 3);
      }
    }
  }
}

void PackStep::add_forces(const Effects& effects, RodForces& forces) const {
  for (std::size_t e = 0; e < effects.size(); ++e) {
    effects[e]->add_forces(pack_, values_[e], forces);
  }
}

}  // namespace fiber
