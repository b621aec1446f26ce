#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

#include "fiber_proximity/sim/effect.hpp"
#include "src/sim/inertia.hpp"
#include "src/sim/solver/line_search.hpp"
#include "src/sim/solver/mass_couplings.hpp"
#include "src/sim/solver/pack_data.hpp"
#include "src/sim/solver/pack_kernels.hpp"

namespace fiber {

/// Rods with the same number of nodes side by side in a step of implicit Euler: where inertia alone
/// would bring them, where they are now, and the incremental potential of that. The result for a
/// rod does not depend on the rods beside it.
class PackStep {
 public:
  /// Replaces the rods of the pack. Memory is reused.
  /// @param members from 1 to lane_count rods
  void assign(const Rods& rods, const std::vector<std::uint32_t>& members) {
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
         {&pack_.masses, &pack_.rest_lengths, &pack_.inverse_stretching_lengths,
          &pack_.inverse_bending_lengths, &pack_.lengths, &pack_.inverse_lengths, &residuals_}) {
      array->resize(nodes);
    }
    pack_.tangents.resize(3 * nodes);
    if (system_.unknowns == 4) {
      for (auto* array : {&pack_.start_directors, &pack_.start_tangents, &pack_.directors}) {
        array->resize(3 * nodes);
      }
      pack_.director_twists.resize(nodes);
      pack_.inverse_twisting_lengths.resize(nodes);
    }
    for (auto* array :
         {&pack_.positions, &inertias_, &scales_, &step_start_, &predicted_, &search_start_}) {
      array->resize(system_.size());
    }
    views_.clear();
    for (std::size_t lane = 0; lane < pack_.used; ++lane) {
      views_.emplace_back(system_, lane);
    }
  }

  const RodPack& rods() const { return pack_; }

  /// The number of SimdBatches of a step: the unknowns, and the zeros after them that solve_band()
  /// requires.
  std::size_t step_size() const { return system_.size() + half_bandwidth(system_.unknowns); }

  /// Begins a step: rates are measured from where the rods are.
  /// @param step [s]
  void begin(const Rods& rods, const Effects& effects, double step) {
    step_length_ = step;
    const std::size_t unknowns = system_.unknowns;
    load_constants(rods, pack_);
    couplings_.assign(rods, pack_);
    for_each_node(pack_, lane_count, [&](std::size_t lane, std::size_t place, std::uint32_t node) {
      const double scale = step_length_ / mass_against_impulse(rods, node);
      for (std::uint32_t k = 0; k < 3; ++k) {
        predicted_[place + k][lane] =
            rods.positions[node][k] + step_length_ * rods.velocities[node][k];
        inertias_[place + k][lane] = rods.masses[node];
        scales_[place + k][lane] = scale;
      }
      if (unknowns == 4) {
        predicted_[place + 3][lane] = rods.angles[node] + step_length_ * rods.spins[node];
        const std::uint32_t rod = pack_.rods[lane];
        const std::uint32_t edge = node - pack_.first_nodes[lane];
        // After the last node there is no edge: its angle stays as it is.
        const double inertia = edge + 1 < pack_.node_count ? rods.section_inertia(rod, node)
                                                           : rods.sections[rod].inertia_per_length;
        inertias_[place + 3][lane] = inertia;
        scales_[place + 3][lane] = rods.radii[rod] * step_length_ / inertia;
        for (std::uint32_t k = 0; k < 3; ++k) {
          pack_.start_directors[3 * edge + k][lane] = rods.directors[node][k];
          pack_.start_tangents[3 * edge + k][lane] = rods.start_tangents[node][k];
        }
      }
    });
    load_values(effects);
    load(rods);
    step_start_ = pack_.positions;
  }

  /// Loads the effects' data of the nodes; to be repeated when multipliers have changed.
  void load_values(const Effects& effects) {
    values_.resize(effects.size());
    for (std::size_t e = 0; e < effects.size(); ++e) {
      fiber::load_values(*effects[e], pack_, values_[e]);
    }
  }

  /// Moves the rods to where they are in Rods.
  void load(const Rods& rods) {
    for_each_node(pack_, lane_count, [&](std::size_t lane, std::size_t place, std::uint32_t node) {
      for (std::uint32_t k = 0; k < 3; ++k) {
        pack_.positions[place + k][lane] = rods.positions[node][k];
      }
      if (system_.unknowns == 4) {
        pack_.positions[place + 3][lane] = rods.angles[node];
      }
    });
    measure_edges(pack_);
  }

  /// The step from where the rods are to where inertia alone would bring them.
  /// @param step step_size() of them, overwritten
  void predict(SimdBatch* step) {
    fill(step, [this](std::size_t i, std::size_t lane) {
      return predicted_[i][lane] - pack_.positions[i][lane];
    });
  }

  /// Moves each rod by a share of a step from where predict() or find_newton_step() began.
  void move(const SimdBatch* step, const SimdBatch& shares) {
    add_scaled({system_.size(), pack_.used}, search_start_.data(), step, shares,
               pack_.positions.data());
    measure_edges(pack_);
  }

  /// Takes a rod back to where it was; measure() is to follow.
  void restore(const std::vector<SimdBatch>& positions, std::size_t lane) {
    for (std::size_t i = 0; i < positions.size(); ++i) {
      pack_.positions[i][lane] = positions[i][lane];
    }
  }

  /// Measures the edges where the rods are.
  void measure() { measure_edges(pack_); }

  /// Kinetic and potential energy of the incremental potential where the rods are now [J].
  void evaluate_energies(const Effects& effects) {
    const SimdBatch kinetic = kinetic_energies_from(predicted_);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      energies_[lane] = EnergySum{};
      energies_[lane].add(kinetic[lane]);
    }
    stored_ = SimdBatch{};
    for (std::size_t e = 0; e < effects.size(); ++e) {
      SimdBatch energy;
      effects[e]->energy(pack_, values_[e], energy);
      const bool is_stored = effects[e]->is_stored();
      for (std::size_t lane = 0; lane < pack_.used; ++lane) {
        energies_[lane].add(energy[lane]);
        stored_[lane] += is_stored ? energy[lane] : 0.0;
      }
    }
  }

  /// Kinetic energies, if the step ended where the rods are now, by lane [J].
  SimdBatch kinetic_energies() const { return kinetic_energies_from(step_start_); }

  const EnergySum& energy(std::size_t lane) const { return energies_[lane]; }

  /// The conservative part of a rod's energy, without inertia [J].
  double stored_energy(std::size_t lane) const { return stored_[lane]; }

  /// Makes gradient and Hessian those of the energies where the rods are now.
  void assemble(const Effects& effects) {
    const double inverse_square = 1.0 / (step_length_ * step_length_);
    const std::size_t height = half_bandwidth(system_.unknowns) + 1;
    system_.set_zero();
    set_inertia({system_.size(), pack_.used}, inverse_square, inertias_.data(),
                pack_.positions.data(), predicted_.data(), system_.gradient.data(),
                system_.hessian.data(), height);
    couplings_.add_derivatives(pack_, predicted_, inverse_square, system_);
    for (std::size_t e = 0; e < effects.size(); ++e) {
      effects[e]->add_derivatives(pack_, values_[e], system_);
    }
  }

  /// The system of one rod, to add contacts to it after assemble().
  RodSystem& system(std::size_t lane) { return views_[lane]; }

  /// The residual of a rod's equations: the largest change of speed [m/s] that the force on a node,
  /// or at the surface the moment on an edge, would cause in a step.
  struct Residual {
    double speed;
    std::uint32_t node;  ///< from the rod's first one
  };
  Residual residual(std::size_t lane) const {
    std::uint32_t worst = 0;
    for (std::uint32_t i = 1; i < pack_.node_count; ++i) {
      worst = residuals_[i][lane] > residuals_[worst][lane] ? i : worst;
    }
    return {std::sqrt(residuals_[worst][lane]), worst};
  }

  void update_residuals() {
    squared_residuals({pack_.node_count, pack_.used}, system_.unknowns, system_.gradient.data(),
                      scales_.data(), residuals_.data());
  }

  /// Factorises the Hessian, and solves for minus the gradient.
  /// @param step step_size() of them, overwritten
  void find_newton_step(SimdBatch* step) {
    // All effects add positive semidefinite blocks, and masses are positive: only rounding errors
    // can make it indefinite, and what it solves for then still lets the energy fall.
    factorise_band(system_);
    fill(step, [this](std::size_t i, std::size_t lane) { return -system_.gradient[i][lane]; });
    solve_band(system_, step);
    clear_nonfinite_steps(step);
  }

  /// The gradient, and the Hessian or after find_newton_step() its factors.
  const PackSystem& system() const { return system_; }

  /// Stores where the rods are, and the velocities that bring them there from where it began.
  void finish(Rods& rods) const {
    store(pack_, rods);
    for_each_node(pack_, pack_.used, [&](std::size_t lane, std::size_t place, std::uint32_t node) {
      const auto rate = [&](std::size_t k) {
        return (pack_.positions[place + k][lane] - step_start_[place + k][lane]) / step_length_;
      };
      rods.velocities[node] = {rate(0), rate(1), rate(2)};
      if (system_.unknowns == 4) {
        rods.spins[node] = rate(3);
      }
    });
  }

  void add_forces(const Effects& effects, RodForces& forces) const {
    for (std::size_t e = 0; e < effects.size(); ++e) {
      effects[e]->add_forces(pack_, values_[e], forces);
    }
  }

 private:
  /// Kinetic energies of the way from some positions to where the rods are, in the time of the
  /// step, by lane [J].
  SimdBatch kinetic_energies_from(const std::vector<SimdBatch>& positions) const {
    SimdBatch energies = weighted_squares({system_.size(), pack_.used}, inertias_.data(),
                                          pack_.positions.data(), positions.data());
    couplings_.add_squares(pack_, positions, energies);
    for (std::size_t lane = 0; lane < lane_count; ++lane) {
      energies[lane] = 0.5 * energies[lane] / (step_length_ * step_length_);
    }
    return energies;
  }

  /// Fills a step from where the rods are by value(unknown, lane), and the zeros after it.
  template <class Value>
  void fill(SimdBatch* step, const Value& value) {
    search_start_ = pack_.positions;
    for (std::size_t i = 0; i < system_.size(); ++i) {
      for (std::size_t lane = 0; lane < lane_count; ++lane) {
        step[i][lane] = value(i, lane);
      }
    }
    std::fill(step + system_.size(), step + step_size(), SimdBatch{});
  }

  /// Where edges have shrunk to nothing, as they may without the effect stretch, stiffnesses
  /// overflow: such a rod has no step.
  void clear_nonfinite_steps(SimdBatch* step) const {
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

  RodPack pack_;
  PackSystem system_;
  std::vector<RodSystem> views_;     // of the system, by lane
  std::vector<SimdBatch> inertias_;  // of unknowns: masses, and moments of inertia of angles
  MassCouplings couplings_;
  std::vector<SimdBatch> scales_;      // from gradient to speed [s/kg], of angles times the radius
  std::vector<SimdBatch> step_start_;  // where rates are measured from
  std::vector<SimdBatch> predicted_;   // where inertia would bring the rods
  std::vector<SimdBatch> search_start_;  // of the step that was found last
  std::vector<SimdBatch> residuals_;     // squared, by node
  std::array<EnergySum, lane_count> energies_;
  SimdBatch stored_;                            // [J]
  std::vector<std::vector<SimdBatch>> values_;  // by effect: its data of the nodes
  double step_length_ = 0.0;                    // [s]
};

}  // namespace fiber
