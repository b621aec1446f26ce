// The forces of joints where a step ends.

#include <map>

#include "src/sim/solver/stage_solver.hpp"

namespace fiber {

using Eigen::Vector3d;

namespace {

/// Where a closed rod begins and ends, its two nodes are one.
PlacedNode named_node(const Rods& rods, const PlacedNode& node) {
  const bool is_end = rods.is_closed(node.rod) && node.node + 1 == rods.end(node.rod);
  return {node.rod, is_end ? rods.first(node.rod) : node.node};
}

}  // namespace

void StageSolver::add_joint_forces(const Rods& rods, RodForces& forces) const {
  const JointParts& parts = joints_->parts();
  std::map<std::uint32_t, std::size_t> places;  // in the forces, by node
  for (std::size_t i = 0; i < parts.places.size(); ++i) {
    for (const PlacedNode& each : parts.places[i]) {
      const PlacedNode node = named_node(rods, each);
      const auto [found, is_new] = places.emplace(node.node, forces.joints.size());
      if (parts.joints[i] < 0) {
        places.erase(found);
      } else if (is_new) {
        forces.joints.push_back({static_cast<std::uint32_t>(parts.joints[i]), node.rod,
                                 node.node - rods.first(node.rod), rods.positions[node.node],
                                 Vector3d::Zero(), Vector3d::Zero()});
      }
    }
  }
  const auto force_on = [&](const PlacedNode& node) -> RodForces::JointForce* {
    const auto found = places.find(named_node(rods, node).node);
    return found == places.end() ? nullptr : &forces.joints[found->second];
  };
  for (const Group& group : groups_) {
    std::size_t next = 0;
    for (const JointCluster* const cluster : group.joints) {
      for (const std::uint32_t place : cluster->places) {
        for (const PlacedNode& each : parts.places[place]) {
          if (RodForces::JointForce* const force = force_on(each)) {
            force->force += group.joint_forces[next].force;
          }
          ++next;
        }
      }
    }
  }
  for (const Weld& weld : parts.welds) {
    const WeldStrain strain(weld, rods, rods);
    const Vector3d moment = strain.moment();
    for (std::size_t i = 0; i < 2; ++i) {
      const WeldedEdge& edge = weld.edges[i];
      if (RodForces::JointForce* const force = force_on({edge.rod, edge.node})) {
        force->moment += i == 0 ? moment : Vector3d(-moment);
      }
      if (weld.is_seam) {
        forces.bending_moments[edge.node] += strain.bending_moment();
      }
    }
    if (weld.is_seam) {
      forces.twisting_moments[weld.edges[1].edge] += strain.twisting_moment();
    }
  }
}

}  // namespace fiber
