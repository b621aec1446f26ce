// The rows of G that joints have, see JointSolver.

#include <algorithm>
#include <cmath>
#include <tuple>

#include "src/sim/solver/joint_solver.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Sorts unknowns, and leaves out those that are there already.
template <class Unknowns>
void sort_unknowns(Unknowns& unknowns) {
  std::sort(unknowns.begin(), unknowns.end());
  unknowns.erase(std::unique(unknowns.begin(), unknowns.end()), unknowns.end());
}

/// @param unknowns sorted, with the one that is looked for
template <class Unknowns>
std::ptrdiff_t index_of(const typename Unknowns::value_type& unknown, const Unknowns& unknowns) {
  return std::lower_bound(unknowns.begin(), unknowns.end(), unknown) - unknowns.begin();
}

/// Finds columns c whose products c cᵀ add up to a positive semidefinite matrix: its Cholesky
/// factor with complete pivoting (Higham 2002, Sect. 10.3).
/// @param matrix overwritten
/// @param root   its first columns are those; as large as the matrix
/// @returns how many columns: the rank
Eigen::Index take_root(Eigen::MatrixXd& matrix, Eigen::MatrixXd& root) {
  constexpr double rounding = 1e-13;
  const double smallest = rounding * matrix.diagonal().maxCoeff();
  root.resize(matrix.rows(), matrix.cols());
  Eigen::Index rank = 0;
  for (; rank < matrix.rows(); ++rank) {
    Eigen::Index pivot = 0;
    const double largest = matrix.diagonal().maxCoeff(&pivot);
    if (!(largest > smallest)) {
      break;
    }
    root.col(rank) = matrix.col(pivot) / std::sqrt(largest);
    matrix.noalias() -= root.col(rank) * root.col(rank).transpose();
  }
  return rank;
}

}  // namespace

/// Adds the rows of a place: the gaps of its other nodes from the first one.
/// @returns the row after them
std::uint32_t JointSolver::add_place_rows(const Problem& problem,
                                          const std::vector<PlacedNode>& place, std::uint32_t row,
                                          ClusterState& state) {
  const auto unknown = [&](const PlacedNode& node, std::uint32_t k) {
    return Unknown{node.rod, problem.places[node.node] + k * lane_count};
  };
  const auto add = [&](const Unknown& by, double derivative) {
    state.parts.push_back({row, by.rod, by.place, 1, state.derivatives.size()});
    state.derivatives.push_back(derivative);
  };
  for (const PlacedNode& node : place) {
    for (std::uint32_t k = 0; k < 3; ++k) {
      state.unknowns.push_back(unknown(node, k));
    }
  }
  for (std::size_t i = 1; i < place.size(); ++i) {
    for (std::uint32_t k = 0; k < 3; ++k, ++row) {
      add(unknown(place.front(), k), -1.0);
      add(unknown(place[i], k), 1.0);
    }
  }
  return row;
}

/// Adds the gradients of the welds of a place to those of the packs, and finds their Hessian.
void JointSolver::add_welds(const Problem& problem, const Rods& rods,
                            const std::vector<RodSystem*>& systems,
                            const std::vector<std::uint32_t>& welds, WeldGroup& group) {
  const bool has_twist = !rods.angles.empty();
  const Eigen::Index count = has_twist ? 7 : 6;  // of unknowns of an edge
  group.unknowns.clear();
  for (const std::uint32_t index : welds) {
    for (const WeldedEdge& edge : problem.parts.welds[index].edges) {
      for (Eigen::Index k = 0; k < count; ++k) {
        group.unknowns.push_back(
            {edge.rod, problem.places[edge.edge] + lane_count * static_cast<std::size_t>(k)});
      }
    }
  }
  sort_unknowns(group.unknowns);
  const auto size = static_cast<Eigen::Index>(group.unknowns.size());
  group.hessian.setZero(size, size);
  for (const std::uint32_t index : welds) {
    const Weld& weld = problem.parts.welds[index];
    const WeldStrain strain(weld, rods, rods);
    const WeldStrain::Derivatives found = strain.derivatives();
    std::array<Eigen::Index, 2> first{};
    for (std::size_t i = 0; i < 2; ++i) {
      const std::uint32_t edge = weld.edges[i].edge;
      RodSystem& system = *systems[weld.edges[i].rod];
      const std::uint32_t node = edge - rods.first(weld.edges[i].rod);
      const ByEdge<1>& gradient = found.gradient[i];
      system.add_gradient(node, gradient.head<3>());
      if (has_twist) {
        system.add_angle_gradient(node, gradient[3]);
      }
      system.add_gradient(node + 1, gradient.segment<3>(has_twist ? 4 : 3));
      first[i] = index_of({weld.edges[i].rod, problem.places[edge]}, group.unknowns);
    }
    for (std::size_t i = 0; i < 2; ++i) {
      for (std::size_t j = 0; j < 2; ++j) {
        group.hessian.block(first[i], first[j], count, count) +=
            found.rows[i].leftCols(count).transpose().lazyProduct(found.rows[j].leftCols(count));
      }
    }
  }
  group.rank = take_root(group.hessian, group.root);
}

/// Adds the rows of the welds of a place.
/// @returns the row after them
std::uint32_t JointSolver::add_weld_rows(const WeldGroup& group, std::uint32_t row,
                                         ClusterState& state) {
  state.unknowns.insert(state.unknowns.end(), group.unknowns.begin(), group.unknowns.end());
  for (std::size_t begin = 0; begin < group.unknowns.size();) {
    const Unknown& first = group.unknowns[begin];
    std::size_t count = 1;
    while (begin + count < group.unknowns.size() &&
           group.unknowns[begin + count].rod == first.rod &&
           group.unknowns[begin + count].place == first.place + lane_count * count) {
      ++count;
    }
    for (Eigen::Index r = 0; r < group.rank; ++r) {
      state.parts.push_back({row + static_cast<std::uint32_t>(r), first.rod, first.place, count,
                             state.derivatives.size()});
      for (std::size_t i = begin; i < begin + count; ++i) {
        state.derivatives.push_back(group.root(static_cast<Eigen::Index>(i), r));
      }
    }
    begin += count;
  }
  return row + static_cast<std::uint32_t>(group.rank);
}

void JointSolver::sort_parts(ClusterState& state) {
  sort_unknowns(state.unknowns);
  for (RowPart& part : state.parts) {
    part.unknown = static_cast<std::size_t>(index_of({part.rod, part.place}, state.unknowns));
  }
  std::sort(state.parts.begin(), state.parts.end(), [](const RowPart& a, const RowPart& b) {
    return std::tie(a.rod, a.row, a.place) < std::tie(b.rod, b.row, b.place);
  });
}

void JointSolver::add_derivatives(const Problem& problem, const Rods& rods,
                                  const std::vector<RodSystem*>& systems) {
  states_.resize(problem.clusters.size());
  for (std::size_t cluster = 0; cluster < problem.clusters.size(); ++cluster) {
    ClusterState& state = states_[cluster];
    state.unknowns.clear();
    state.parts.clear();
    state.derivatives.clear();
    std::uint32_t row = 0;
    for (const std::uint32_t place : problem.clusters[cluster]->places) {
      row = add_place_rows(problem, problem.parts.places[place], row, state);
    }
    const std::uint32_t constraints = row;
    const std::vector<std::vector<std::uint32_t>>& welds = problem.clusters[cluster]->welds;
    state.groups.resize(welds.size());
    for (std::size_t place = 0; place < welds.size(); ++place) {
      add_welds(problem, rods, systems, welds[place], state.groups[place]);
      row = add_weld_rows(state.groups[place], row, state);
    }
    sort_parts(state);
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

}  // namespace fiber
