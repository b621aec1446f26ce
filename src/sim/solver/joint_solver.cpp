#include "src/sim/solver/joint_solver.hpp"

#include <algorithm>
#include <numeric>
#include <tuple>

#include "src/sim/solver/pack_kernels.hpp"

namespace fiber {

using Eigen::Vector3d;

std::vector<JointCluster> joint_clusters(const JointParts& parts, std::uint32_t rods) {
  std::vector<std::uint32_t> cluster_of(rods);
  std::iota(cluster_of.begin(), cluster_of.end(), 0U);
  const auto root = [&](std::uint32_t rod) {
    while (cluster_of[rod] != rod) {
      rod = cluster_of[rod];
    }
    return rod;
  };
  for (const std::vector<PlacedNode>& place : parts.places) {
    for (const PlacedNode& each : place) {
      const auto [first, other] = std::minmax({root(place.front().rod), root(each.rod)});
      cluster_of[other] = first;
    }
  }
  std::vector<JointCluster> clusters;
  std::vector<std::size_t> index_of(rods, rods);
  for (std::uint32_t i = 0; i < parts.places.size(); ++i) {
    std::size_t& index = index_of[root(parts.places[i].front().rod)];
    if (index == rods) {
      index = clusters.size();
      clusters.emplace_back();
    }
    clusters[index].places.push_back(i);
  }
  for (std::uint32_t i = 0; i < parts.welds.size(); ++i) {
    clusters[index_of[root(parts.welds[i].edges[0].rod)]].welds.push_back(i);
  }
  return clusters;
}

double JointSolver::RowPart::product(const double* some, std::size_t begin) const {
  double sum = 0.0;
  for (std::size_t i = 0; i < count; ++i) {
    sum += values[i] * some[first - begin + lane_count * i];
  }
  return sum;
}

void JointSolver::RowPart::add_to(double* some, std::size_t begin, double factor) const {
  for (std::size_t i = 0; i < count; ++i) {
    some[first - begin + lane_count * i] += factor * values[i];
  }
}

void JointSolver::evaluate_energies(const Problem& problem, const Rods& rods) {
  energies_.assign(problem.clusters.size(), EnergySum{});
  stored_.assign(problem.clusters.size(), 0.0);
  for (std::size_t cluster = 0; cluster < problem.clusters.size(); ++cluster) {
    for (const std::uint32_t weld : problem.clusters[cluster]->welds) {
      const WeldStrain strain(problem.parts.welds[weld], rods, rods);
      energies_[cluster].add(strain.energy());
      stored_[cluster] += strain.stored_energy();
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

/// Adds the rows of a place: the gaps of its other nodes from the first one.
/// @returns the row after them
std::uint32_t JointSolver::add_place_rows(const Problem& problem,
                                          const std::vector<PlacedNode>& place, std::uint32_t row,
                                          ClusterState& state) const {
  for (std::size_t i = 1; i < place.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k, ++row) {
      const auto part = [&](const PlacedNode& node, std::uint32_t end, double value) {
        return RowPart{row, node.rod, problem.places[node.node] + k * lane_count, 1, end, {value}};
      };
      state.parts.push_back(part(place.front(), 0, -1.0));
      state.parts.push_back(part(place[i], 1, 1.0));
    }
  }
  return row;
}

void JointSolver::add_derivatives(const Problem& problem, const Rods& rods,
                                  const std::vector<RodSystem*>& systems) {
  const bool has_twist = !rods.angles.empty();
  states_.resize(problem.clusters.size());
  for (std::size_t cluster = 0; cluster < problem.clusters.size(); ++cluster) {
    ClusterState& state = states_[cluster];
    state.parts.clear();
    std::uint32_t row = 0;
    for (const std::uint32_t place : problem.clusters[cluster]->places) {
      row = add_place_rows(problem, problem.parts.places[place], row, state);
    }
    const std::uint32_t constraints = row;
    for (const std::uint32_t index : problem.clusters[cluster]->welds) {
      const Weld& weld = problem.parts.welds[index];
      const WeldStrain strain(weld, rods, rods);
      const WeldStrain::Derivatives found = strain.derivatives();
      for (std::uint32_t i = 0; i < 2; ++i) {
        const std::uint32_t rod = weld.edges[i].rod;
        const std::uint32_t edge = weld.edges[i].edge;
        RodSystem& system = *systems[rod];
        const std::uint32_t node = edge - rods.first(rod);
        const ByEdge<1>& gradient = found.gradient[i];
        system.add_gradient(node, gradient.head<3>());
        if (has_twist) {
          system.add_angle_gradient(node, gradient[3]);
        }
        system.add_gradient(node + 1, gradient.segment<3>(has_twist ? 4 : 3));
        for (int r = 0; r < strain.row_count(); ++r) {
          RowPart part{row + static_cast<std::uint32_t>(r),
                       rod,
                       problem.places[edge],
                       has_twist ? 7U : 6U,
                       i,
                       {}};
          Eigen::Map<ByEdge<1>>(part.values.data()) = found.rows[i].row(r);
          state.parts.push_back(part);
        }
      }
      row += static_cast<std::uint32_t>(strain.row_count());
    }
    std::sort(state.parts.begin(), state.parts.end(), [](const RowPart& a, const RowPart& b) {
      return std::tie(a.rod, a.row, a.end) < std::tie(b.rod, b.row, b.end);
    });
    state.matrix.setZero(row, row);
    state.matrix.diagonal().tail(row - constraints).setOnes();
  }
  unite_gradients(problem, rods, systems);
}

void JointSolver::unite_gradients(const Problem& problem, const Rods& rods,
                                  const std::vector<RodSystem*>& systems) {
  forces_.clear();
  masses_.clear();
  for (const JointCluster* const cluster : problem.clusters) {
    for (const std::uint32_t index : cluster->places) {
      const std::vector<PlacedNode>& place = problem.parts.places[index];
      const std::size_t first = forces_.size();
      Vector3d sum = Vector3d::Zero();
      double mass = 0.0;
      for (const auto& [rod, node] : place) {
        const RodSystem& system = *systems[rod];
        const std::size_t unknown = std::size_t{node - rods.first(rod)} * system.unknowns();
        const Vector3d gradient(system.gradient(unknown), system.gradient(unknown + 1),
                                system.gradient(unknown + 2));
        forces_.push_back({node, gradient});
        masses_.push_back(rods.masses[node]);
        sum += gradient;
        mass += rods.masses[node];
      }
      for (std::size_t i = 0; i < place.size(); ++i) {
        Vector3d& force = forces_[first + i].force;
        const Vector3d own = masses_[first + i] / mass * sum;
        const auto& [rod, node] = place[i];
        // Set, not added to: nodes of a place have the same residual to the last bit.
        systems[rod]->add_gradient(node - rods.first(rod), own - force);
        force -= own;
      }
    }
  }
}

/// Finds which parts belong to one column, by pack and rod.
void JointSolver::find_columns(const Problem& problem) {
  columns_.resize(problem.offsets.size());
  for (PackColumns& pack : columns_) {
    pack.rods.clear();
    pack.columns.clear();
  }
  for (std::uint32_t cluster = 0; cluster < states_.size(); ++cluster) {
    const std::vector<RowPart>& parts = states_[cluster].parts;
    for (std::size_t begin = 0; begin < parts.size();) {
      std::size_t end = begin + 1;
      while (end < parts.size() && parts[end].rod == parts[begin].rod &&
             parts[end].row == parts[begin].row) {
        ++end;
      }
      PackColumns& pack = columns_[problem.packs[parts[begin].rod]];
      const std::size_t index = pack.columns.size();
      if (pack.rods.empty() || pack.rods.back().rod != parts[begin].rod) {
        pack.rods.push_back({parts[begin].rod, index, index});
      }
      pack.columns.push_back({cluster, begin, end});
      ++pack.rods.back().end;
      begin = end;
    }
  }
}

/// The columns of B⁻¹ Gᵀ are found for all rods of a pack side by side; only what G takes from them
/// is kept.
void JointSolver::factorise(const Problem& problem, const std::vector<PackStep>& packs) {
  find_columns(problem);
  for (std::size_t pack = 0; pack < packs.size(); ++pack) {
    const auto& [rods, columns] = columns_[pack];
    std::size_t count = 0;
    for (const RodColumns& rod : rods) {
      count = std::max(count, rod.count());
    }
    column_.resize(packs[pack].step_size());
    double* const values = column_.data()->lanes.data();
    const std::size_t begin = problem.offsets[pack] * lane_count;
    for (std::size_t i = 0; i < count; ++i) {
      std::fill(column_.begin(), column_.end(), SimdBatch{});
      for (const RodColumns& rod : rods) {
        if (i < rod.count()) {
          const Column& column = columns[rod.begin + i];
          for (std::size_t part = column.begin; part < column.end; ++part) {
            states_[column.cluster].parts[part].add_to(values, begin, 1.0);
          }
        }
      }
      solve_band(packs[pack].system(), column_.data());
      for (const RodColumns& rod : rods) {
        if (i < rod.count()) {
          const Column& column = columns[rod.begin + i];
          ClusterState& state = states_[column.cluster];
          const std::uint32_t by = state.parts[column.begin].row;
          for (std::size_t part = column.begin; part < columns[rod.end - 1].end; ++part) {
            state.matrix(state.parts[part].row, by) += state.parts[part].product(values, begin);
          }
        }
      }
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
      state.values[part.row] += part.product(all, 0);
    }
    state.factors.solveInPlace(state.values);
    for (const RowPart& part : state.parts) {
      part.add_to(right_side, 0, -state.values[part.row]);
    }
  }
  for (std::size_t pack = 0; pack < packs.size(); ++pack) {
    if (!columns_[pack].rods.empty()) {
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
