// The part of a solve that gives impacts their restitution, see Impact.

#include <algorithm>
#include <cmath>
#include <iterator>
#include <map>
#include <optional>
#include <tuple>

#include "src/sim/inertia.hpp"
#include "src/sim/solver/newton.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// A node of an impact and the edge after it, with their velocity and spin before it.
struct StruckNode {
  std::uint32_t rod;
  std::uint32_t node;
  bool is_joined_only = false;  ///< with one that is of an impact
  Vector3d velocity = Vector3d::Zero();
  double spin = 0.0;
};

/// The nodes of some impacts, and those joined or coupled with them, each once, in order.
/// @param joints null for none
std::vector<StruckNode> struck_nodes(const Rods& rods, const std::vector<Impact>& impacts,
                                     const JointParts* joints) {
  std::vector<StruckNode> nodes;
  for (const Impact& impact : impacts) {
    const ContactPoints& points = impact.points;
    nodes.insert(nodes.end(), {{points.rod_a, points.edge_a}, {points.rod_a, points.edge_a + 1}});
    if (points.is_of_rods()) {
      nodes.insert(nodes.end(), {{points.rod_b, points.edge_b}, {points.rod_b, points.edge_b + 1}});
    }
  }
  for (std::size_t i = 0, struck = nodes.size(); joints != nullptr && i < struck; ++i) {
    const std::int32_t place = rods.joints[nodes[i].node];
    if (place >= 0) {
      for (const PlacedNode& each : joints->places[static_cast<std::size_t>(place)]) {
        nodes.push_back({each.rod, each.node, true});
      }
    }
  }
  for (std::size_t i = 0, struck = nodes.size(); i < struck; ++i) {
    if (const std::optional<std::uint32_t> other = coupled_node(rods, nodes[i].node)) {
      nodes.push_back({nodes[i].rod, *other});
    }
  }
  std::sort(nodes.begin(), nodes.end(), [](const StruckNode& a, const StruckNode& b) {
    return std::tie(a.node, a.is_joined_only) < std::tie(b.node, b.is_joined_only);
  });
  const auto is_same = [](const StruckNode& a, const StruckNode& b) { return a.node == b.node; };
  nodes.erase(std::unique(nodes.begin(), nodes.end(), is_same), nodes.end());
  for (StruckNode& each : nodes) {
    each.velocity = rods.velocities[each.node];
    each.spin = rods.spins.empty() ? 0.0 : rods.spins[each.node];
  }
  return nodes;
}

/// One of struck_nodes(), null if it is none of them.
const StruckNode* find_node(const std::vector<StruckNode>& nodes, std::uint32_t node) {
  const auto found = std::lower_bound(
      nodes.begin(), nodes.end(), node,
      [](const StruckNode& struck, std::uint32_t searched) { return struck.node < searched; });
  return found != nodes.end() && found->node == node ? &*found : nullptr;
}

/// The places of joints in impacts. A node there is as heavy as its place while impulses act on it,
/// or as its share of that if several of the place's nodes are struck; then all of them have what
/// these have been given.
class StruckPlaces {
 public:
  /// @param nodes with all that are joined with them
  StruckPlaces(Rods& rods, const std::vector<StruckNode>& nodes) : rods_(rods), nodes_(nodes) {
    for (const StruckNode& each : nodes) {
      masses_.push_back(rods.masses[each.node]);
      if (rods.joints[each.node] >= 0) {
        Place& place = places_[rods.joints[each.node]];
        place.mass += rods.masses[each.node];
        place.struck += each.is_joined_only ? 0.0 : 1.0;
      }
    }
    for (const StruckNode& each : nodes) {
      if (rods.joints[each.node] >= 0) {
        const Place& place = places_[rods.joints[each.node]];
        rods.masses[each.node] = place.mass / place.struck;
      }
    }
  }

  void finish() {
    for (std::size_t i = 0; i < nodes_.size(); ++i) {
      const StruckNode& each = nodes_[i];
      rods_.masses[each.node] = masses_[i];
      if (rods_.joints[each.node] >= 0) {
        Place& place = places_[rods_.joints[each.node]];
        place.change += (rods_.velocities[each.node] - each.velocity) / place.struck;
      }
    }
    for (const StruckNode& each : nodes_) {
      if (rods_.joints[each.node] >= 0) {
        rods_.velocities[each.node] = each.velocity + places_[rods_.joints[each.node]].change;
      }
    }
  }

 private:
  struct Place {
    double mass = 0.0;    // [kg]
    double struck = 0.0;  // how many of its nodes
    Vector3d change = Vector3d::Zero();
  };

  Rods& rods_;
  const std::vector<StruckNode>& nodes_;
  std::vector<double> masses_;  // by node of these [kg]
  std::map<std::int32_t, Place> places_;
};

/// The work of moving obstacles by some impacts [J].
double work_of(const std::vector<Impact>& impacts) {
  double work = 0.0;
  for (const Impact& impact : impacts) {
    work += (impact.pressure * impact.normal + impact.friction).dot(impact.obstacle_velocity);
  }
  return work;
}

/// The largest part, up to 1, of a change of velocities and spins that adds no more kinetic energy
/// than is allowed [J].
/// @param work of obstacles by all of the change [J]
double allowed_share(const std::vector<StruckNode>& nodes, const Rods& after, double allowed,
                     double work) {
  double linear = -work;  // the energy by the share y is y linear + y² square
  double square = 0.0;
  const auto velocity_before = [&](std::uint32_t node) {
    const StruckNode* const struck = find_node(nodes, node);
    return struck != nullptr ? struck->velocity : after.velocities[node];
  };
  const auto add_coupling = [&](std::uint32_t edge) {
    const Vector3d before = velocity_before(edge + 1) - velocity_before(edge);
    const Vector3d change = after.velocities[edge + 1] - after.velocities[edge] - before;
    linear -= after.mass_couplings[edge] * before.dot(change);
    square -= 0.5 * after.mass_couplings[edge] * change.squaredNorm();
  };
  for (const StruckNode& before : nodes) {
    const double mass = after.masses[before.node];
    const Vector3d change = after.velocities[before.node] - before.velocity;
    linear += mass * before.velocity.dot(change);
    square += 0.5 * mass * change.squaredNorm();
    if (after.is_rigid(before.node)) {
      add_coupling(before.node);
    } else if (before.node > 0 && after.is_rigid(before.node - 1) &&
               find_node(nodes, before.node - 1) == nullptr) {
      add_coupling(before.node - 1);
    }
    if (!after.spins.empty()) {
      const double inertia = after.section_inertia(before.rod, before.node);
      const double spin_change = after.spins[before.node] - before.spin;
      linear += inertia * before.spin * spin_change;
      square += 0.5 * inertia * spin_change * spin_change;
    }
  }
  if (linear + square <= allowed) {
    return 1.0;
  }
  return (std::sqrt(linear * linear + 4.0 * square * allowed) - linear) / (2.0 * square);
}

}  // namespace

/// Stored energy of rods and contacts where they were evaluated last, by island [J].
void NewtonSolver::find_stored_energies(const Problem& problem, std::vector<double>& stored) const {
  stored.assign(states_.size(), 0.0);
  for (std::size_t pack = 0; pack < packs_.size(); ++pack) {
    for (std::size_t lane = 0; lane < packs_[pack].rods().used; ++lane) {
      stored[islands_[pack][lane]] += packs_[pack].stored_energy(lane);
    }
  }
  if (problem.contacts != nullptr) {
    problem.contacts->add_stored_energies(scratch_->islands, stored);
  }
  if (problem.joints != nullptr) {
    joint_solver_.add_stored_energies(joint_problem(problem), stored);
  }
}

/// Kinetic energy of the rods at their velocities, by island [J].
void NewtonSolver::find_kinetic_energies(const Rods& rods, std::vector<double>& energies) const {
  energies.assign(states_.size(), 0.0);
  for (const std::uint32_t rod : members_) {
    add_kinetic_energy(rods, rod, energies[scratch_->islands[rod]]);
  }
}

/// Finds the kinetic energy with which the solve gains none where the rods are, by island: all that
/// there was and is not stored, and what moving obstacles have done.
void NewtonSolver::find_max_kinetic() {
  max_kinetic_.clear();
  for (std::size_t i = 0; i < states_.size(); ++i) {
    max_kinetic_.push_back(kinetic_of_start_[i] + stored_of_start_[i] - stored_[i] +
                           obstacle_work_[i]);
  }
}

/// Changes velocities and spins by the impacts of each island, which give back no more energy than
/// the solve and obstacles have taken from it, and takes back what contacts return of impacts
/// before.
/// @returns the work of moving obstacles by them [J]
double NewtonSolver::resolve_impacts(Rods& rods, const Problem& problem,
                                     const std::vector<Impact>& impacts) {
  const double coefficient = problem.friction != nullptr ? problem.friction->coefficient() : 0.0;
  find_kinetic_energies(rods, kinetic_);
  double work = 0.0;
  for (std::uint32_t island = 0; island < states_.size(); ++island) {
    std::vector<Impact> own;
    std::copy_if(
        impacts.begin(), impacts.end(), std::back_inserter(own),
        [&](const Impact& impact) { return scratch_->islands[impact.points.rod_a] == island; });
    has_impacts_[island] =
        has_impacts_[island] || std::any_of(own.begin(), own.end(), [&](const Impact& impact) {
          return is_returning(impact, rods);
        });
    if (!has_impacts_[island]) {
      continue;
    }
    const std::vector<StruckNode> before = struck_nodes(rods, own, problem.joints);
    if (problem.joints != nullptr) {
      StruckPlaces places(rods, before);
      resolve(rods, coefficient, own);
      places.finish();
    } else {
      resolve(rods, coefficient, own);
    }
    const double share = allowed_share(
        before, rods, std::max(0.0, max_kinetic_[island] - kinetic_[island]), work_of(own));
    for (const StruckNode& each : before) {
      Vector3d& velocity = rods.velocities[each.node];
      velocity = each.velocity + share * (velocity - each.velocity);
      if (!rods.spins.empty()) {
        double& spin = rods.spins[each.node];
        spin = each.spin + share * (spin - each.spin);
      }
    }
    for (Impact& impact : own) {
      impact.pressure *= share;
      impact.friction *= share;
    }
    work += work_of(own);
    problem.contacts->add_impacts(own);
    reports_[island].impacts = static_cast<std::uint32_t>(own.size());
  }
  return work;
}

}  // namespace fiber
