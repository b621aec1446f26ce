#include "rod_batch.hpp"

#include <algorithm>

#include "lane_sums.hpp"

namespace fiber {

using Eigen::Vector3d;

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
  measure_edges(lanes_);
}

void RodBatch::stay() {
  lanes_.positions = beginning_;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    for (const std::uint32_t node : held_[lane]) {
      const std::size_t first = node * system_.unknowns;
      for (std::size_t place = first; place < first + 3; ++place) {
        lanes_.positions[place][lane] = remembered_[place][lane];
      }
    }
  }
  measure_edges(lanes_);
}

bool RodBatch::drift() {
  const std::size_t unknowns = system_.unknowns;
  bool is_any_free = false;
  for (std::size_t lane = 0; lane < lanes_.used; ++lane) {
    if (!held_[lane].empty()) {
      continue;
    }
    is_any_free = true;
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
  if (is_any_free) {
    measure_edges(lanes_);
  }
  return is_any_free;
}

void RodBatch::restore(const LaneFlags& which) {
  for (std::size_t i = 0; i < system_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      lanes_.positions[i][lane] = which[lane] ? remembered_[i][lane] : lanes_.positions[i][lane];
    }
  }
  measure_edges(lanes_);
}

void RodBatch::move(const Lanes* step, const Lanes& shares) {
  move_by(system_.size(), remembered_.data(), step, shares, lanes_.positions.data());
  measure_edges(lanes_);
}

void RodBatch::way_back(const LaneFlags& which, Lanes* step) const {
  for (std::size_t i = 0; i < system_.size(); ++i) {
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      step[i][lane] = which[lane] ? beginning_[i][lane] - lanes_.positions[i][lane] : 0.0;
    }
  }
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
