#include "src/sim/solver/joint_solver.hpp"

#include <algorithm>
#include <map>
#include <utility>

#include "src/geometry/disjoint_sets.hpp"
#include "src/sim/solver/pack_kernels.hpp"

namespace fiber {

std::vector<JointCluster> joint_clusters(const JointParts& parts, std::uint32_t rods) {
  DisjointSets joined(rods);
  for (const std::vector<PlacedNode>& place : parts.places) {
    for (const PlacedNode& each : place) {
      joined.join(place.front().rod, each.rod);
    }
  }
  std::vector<std::uint32_t> first_rod_of;  // by rod: of its cluster
  joined.find_roots(first_rod_of);
  std::vector<JointCluster> clusters;
  std::map<std::uint32_t, std::uint32_t> place_of;  // by node
  std::vector<std::size_t> index_of(rods, rods);
  for (std::uint32_t i = 0; i < parts.places.size(); ++i) {
    std::size_t& index = index_of[first_rod_of[parts.places[i].front().rod]];
    if (index == rods) {
      index = clusters.size();
      clusters.emplace_back();
    }
    clusters[index].places.push_back(i);
    for (const PlacedNode& each : parts.places[i]) {
      place_of.emplace(each.node, i);
    }
  }
  std::map<std::uint32_t, std::vector<std::uint32_t>> welds;  // by place
  for (std::uint32_t i = 0; i < parts.welds.size(); ++i) {
    welds[place_of.at(parts.welds[i].edges[0].node)].push_back(i);
  }
  for (auto& [place, of_place] : welds) {
    clusters[index_of[first_rod_of[parts.places[place].front().rod]]].welds.push_back(
        std::move(of_place));
  }
  return clusters;
}

double JointSolver::ClusterState::product(const RowPart& part, const double* some) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < part.count; ++i) {
    sum += derivatives[part.derivative + i] * some[part.place + lane_count * i];
  }
  return sum;
}

void JointSolver::ClusterState::add_to(const RowPart& part, double factor, double* some) const {
  for (std::size_t i = 0; i < part.count; ++i) {
    some[part.place + lane_count * i] += factor * derivatives[part.derivative + i];
  }
}

void JointSolver::evaluate_energies(const Problem& problem, const Rods& rods) {
  energies_.assign(problem.clusters.size(), EnergySum{});
  stored_.assign(problem.clusters.size(), 0.0);
  for (std::size_t cluster = 0; cluster < problem.clusters.size(); ++cluster) {
    for (const std::vector<std::uint32_t>& of_place : problem.clusters[cluster]->welds) {
      for (const std::uint32_t weld : of_place) {
        const WeldStrain strain(problem.parts.welds[weld], rods, rods);
        energies_[cluster].add(strain.energy());
        stored_[cluster] += strain.stored_energy();
      }
    }
  }
}

void JointSolver::add_energies(const Problem& problem, std::vector<EnergySum>& energies) const {
  for (std::size_t cluster = 0; cluster < problem.clusters.size(); ++cluster) {
    energies[problem.islands[problem.clusters[cluster]->rod(problem.parts)]].add(
        energies_[cluster]);
  }
}

void JointSolver::add_stored_energies(const Problem& problem, std::vector<double>& energies) const {
  for (std::size_t cluster = 0; cluster < problem.clusters.size(); ++cluster) {
    energies[problem.islands[problem.clusters[cluster]->rod(problem.parts)]] += stored_[cluster];
  }
}

/// Finds the rods of each pack that have joints.
void JointSolver::find_rods(const Problem& problem) {
  rods_.resize(problem.offsets.size());
  for (std::vector<RodPart>& rods : rods_) {
    rods.clear();
  }
  std::size_t responses = 0;
  for (std::uint32_t cluster = 0; cluster < states_.size(); ++cluster) {
    const ClusterState& state = states_[cluster];
    std::size_t unknown = 0;
    for (std::size_t part = 0; part < state.parts.size();) {
      RodPart rod{state.parts[part].rod, cluster, part, part, unknown, unknown, responses};
      while (rod.end_part < state.parts.size() && state.parts[rod.end_part].rod == rod.rod) {
        ++rod.end_part;
      }
      while (rod.end_unknown < state.unknowns.size() &&
             state.unknowns[rod.end_unknown].rod == rod.rod) {
        ++rod.end_unknown;
      }
      part = rod.end_part;
      unknown = rod.end_unknown;
      responses += rod.unknown_count() * rod.unknown_count();
      rods_[problem.packs[rod.rod]].push_back(rod);
    }
  }
  responses_.resize(responses);
}

/// Adds G B⁻¹ Gᵀ by one rod: the rows from the diagonal down.
void JointSolver::add_response(const RodPart& rod) {
  ClusterState& state = states_[rod.cluster];
  const std::size_t count = rod.unknown_count();
  const Eigen::Map<Eigen::MatrixXd> response = response_of(rod);
  by_row_.resize(count);
  Eigen::Map<Eigen::VectorXd> moved(by_row_.data(), static_cast<Eigen::Index>(count));
  for (std::size_t begin = rod.first_part; begin < rod.end_part;) {
    const std::uint32_t by = state.parts[begin].row;
    moved.setZero();
    std::size_t end = begin;
    for (; end < rod.end_part && state.parts[end].row == by; ++end) {
      const RowPart& part = state.parts[end];
      for (std::size_t i = 0; i < part.count; ++i) {
        moved += state.derivatives[part.derivative + i] *
                 response.col(static_cast<Eigen::Index>(part.unknown - rod.first_unknown + i));
      }
    }
    for (std::size_t other = begin; other < rod.end_part; ++other) {
      const RowPart& part = state.parts[other];
      double sum = 0.0;
      for (std::size_t i = 0; i < part.count; ++i) {
        sum +=
            state.derivatives[part.derivative + i] * by_row_[part.unknown - rod.first_unknown + i];
      }
      state.matrix(part.row, by) += sum;
    }
    begin = end;
  }
}

/// The columns of B⁻¹ for joined unknowns are found for all rods of a pack side by side; only the
/// rows for such unknowns are kept.
void JointSolver::factorise(const Problem& problem, const std::vector<PackStep>& packs) {
  find_rods(problem);
  for (std::size_t pack = 0; pack < packs.size(); ++pack) {
    std::size_t count = 0;
    for (const RodPart& rod : rods_[pack]) {
      count = std::max(count, rod.unknown_count());
    }
    column_.resize(packs[pack].step_size());
    double* const values = column_.data()->lanes.data();
    const std::size_t begin = problem.offsets[pack] * lane_count;
    for (std::size_t i = 0; i < count; ++i) {
      std::fill(column_.begin(), column_.end(), SimdBatch{});
      for (const RodPart& rod : rods_[pack]) {
        if (i < rod.unknown_count()) {
          values[states_[rod.cluster].unknowns[rod.first_unknown + i].place - begin] = 1.0;
        }
      }
      solve_band(packs[pack].system(), column_.data());
      for (const RodPart& rod : rods_[pack]) {
        for (std::size_t k = 0; i < rod.unknown_count() && k < rod.unknown_count(); ++k) {
          response_of(rod)(static_cast<Eigen::Index>(k), static_cast<Eigen::Index>(i)) =
              values[states_[rod.cluster].unknowns[rod.first_unknown + k].place - begin];
        }
      }
    }
    for (const RodPart& rod : rods_[pack]) {
      add_response(rod);
    }
  }
  for (ClusterState& state : states_) {
    state.factors.compute(state.matrix);
  }
}

void JointSolver::solve(const Problem& problem, const std::vector<PackStep>& packs,
                        const std::vector<SimdBatch>& r, std::vector<SimdBatch>& values) {
  right_sides_ = r;
  double* const right_side = right_sides_.data()->lanes.data();
  const double* const all = values.data()->lanes.data();
  for (ClusterState& state : states_) {
    state.values.setZero(state.matrix.rows());
    for (const RowPart& part : state.parts) {
      state.values[part.row] += state.product(part, all);
    }
    state.factors.solveInPlace(state.values);
    for (const RowPart& part : state.parts) {
      state.add_to(part, -state.values[part.row], right_side);
    }
  }
  for (std::size_t pack = 0; pack < packs.size(); ++pack) {
    if (!rods_[pack].empty()) {
      const std::size_t first = problem.offsets[pack];
      const std::size_t size = packs[pack].step_size();
      solve_band(packs[pack].system(), &right_sides_[first]);
      std::copy_n(&right_sides_[first], size, &values[first]);
    }
  }
  unite(problem, values);
}

/// Makes the displacements of each place's nodes the same to the last bit.
void JointSolver::unite(const Problem& problem, std::vector<SimdBatch>& values) const {
  double* const all = values.data()->lanes.data();
  std::size_t first = 0;
  for (const JointCluster* const cluster : problem.clusters) {
    for (const std::uint32_t index : cluster->places) {
      const std::vector<PlacedNode>& place = problem.parts.places[index];
      for (std::size_t k = 0; k < 3; ++k) {
        double sum = 0.0;
        double mass = 0.0;
        for (std::size_t i = 0; i < place.size(); ++i) {
          sum += masses_[first + i] * all[problem.places[place[i].node] + k * lane_count];
          mass += masses_[first + i];
        }
        for (const PlacedNode& each : place) {
          all[problem.places[each.node] + k * lane_count] = sum / mass;
        }
      }
      first += place.size();
    }
  }
}

}  // namespace fiber
