#include "src/sim/inertia.hpp"

namespace fiber {

namespace {

/// The rigid part that a node is an end of, as an impulse on the node has it.
struct RigidPart {
  double mass = 0.0;  // [kg] of Rods::mass_couplings; 0: there is none
  std::uint32_t edge = 0;
  std::uint32_t other = 0;  // the node at the other end
};

bool is_joined(const Rods& rods, std::uint32_t node) {
  return !rods.joints.empty() && rods.joints[node] >= 0;
}

/// No node is of two: rigid parts do not follow each other.
RigidPart part_at(const Rods& rods, std::uint32_t node) {
  RigidPart part;
  if (rods.mass_couplings.empty()) {
    return part;
  }
  if (rods.is_rigid(node)) {
    part = {rods.mass_couplings[node], node, node + 1};
  } else if (node > 0 && rods.is_rigid(node - 1)) {
    part = {rods.mass_couplings[node - 1], node - 1, node - 1};
  }
  const bool is_of_joint =
      part.mass != 0.0 && (is_joined(rods, node) || is_joined(rods, part.other));
  return is_of_joint ? RigidPart() : part;
}

/// How the other end's velocity changes as the node's does.
double change_of_other(const Rods& rods, const RigidPart& part) {
  return -part.mass / (rods.masses[part.other] - part.mass);
}

}  // namespace

void add_kinetic_energy(const Rods& rods, std::uint32_t rod, double& energy) {
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    energy += 0.5 * rods.masses[i] * rods.velocities[i].squaredNorm();
    if (!rods.spins.empty()) {
      energy += 0.5 * rods.section_inertia(rod, i) * rods.spins[i] * rods.spins[i];
    }
    if (rods.is_rigid(i)) {
      energy -= 0.5 * rods.mass_couplings[i] *
                (rods.velocities[i + 1] - rods.velocities[i]).squaredNorm();
    }
  }
}

double mass_against_impulse(const Rods& rods, std::uint32_t node) {
  const RigidPart part = part_at(rods, node);
  return part.mass == 0.0 ? rods.masses[node]
                          : rods.masses[node] - part.mass + part.mass * change_of_other(rods, part);
}

double coupled_mobility(const Rods& rods, std::uint32_t edge) {
  const RigidPart part = part_at(rods, edge);
  return part.mass == 0.0 || part.edge != edge
             ? 0.0
             : change_of_other(rods, part) / mass_against_impulse(rods, edge);
}

std::optional<std::uint32_t> coupled_node(const Rods& rods, std::uint32_t node) {
  const RigidPart part = part_at(rods, node);
  return part.mass == 0.0 ? std::nullopt : std::optional<std::uint32_t>(part.other);
}

void change_velocity(Rods& rods, std::uint32_t node, const Eigen::Vector3d& change) {
  rods.velocities[node] += change;
  const RigidPart part = part_at(rods, node);
  if (part.mass != 0.0) {
    rods.velocities[part.other] += change_of_other(rods, part) * change;
  }
}

}  // namespace fiber
