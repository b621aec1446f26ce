#pragma once

#include <Eigen/Geometry>
#include <memory>
#include <numeric>
#include <vector>

#include "fiber_proximity/sim/rods.hpp"
#include "test/support/random.hpp"

namespace fiber::test {

/// How far from a rod's first node another one is, as Rods::set_sections() adds lengths up [m].
inline double arc_to(const Rods& rods, std::uint32_t rod, std::uint32_t node) {
  const auto first = rods.rest_lengths.begin() + rods.first(rod);
  return std::accumulate(first, first + node, 0.0);
}

/// A chain of edges of about the given length, each of which turns by a random part of a right
/// angle.
inline std::vector<Eigen::Vector3d> random_chain(Random& random, int nodes, double edge_length) {
  std::vector<Eigen::Vector3d> points{random.in_cube()};
  Eigen::Vector3d direction = random.direction();
  while (points.size() < static_cast<std::size_t>(nodes)) {
    points.push_back(points.back() + random.uniform(0.7, 1.3) * edge_length * direction);
    direction = (direction + random.uniform(0.0, 0.9) * random.direction()).normalized();
  }
  return points;
}

/// Stiffnesses and masses that differ, but not by many powers of ten: differences of energies are
/// to show each of them.
inline RodSection random_section(Random& random) {
  return {random.uniform(1.0, 10.0), random.uniform(0.1, 1.0), random.uniform(0.1, 1.0),
          random.uniform(0.1, 1.0), random.uniform(0.01, 0.1)};
}

/// Some rods of few nodes, the first of one edge and the second of two; at rest.
inline Rods random_rods(Random& random, double edge_length = 0.3) {
  Rods rods;
  for (const int nodes : {2, 3, random.integer(4, 9)}) {
    rods.add(random_chain(random, nodes, edge_length), 0.01, random_section(random));
  }
  return rods;
}

/// Rods with the same number of nodes, at rest.
inline Rods rods_of_equal_sizes(Random& random, int count, int nodes, double edge_length) {
  Rods rods;
  for (int rod = 0; rod < count; ++rod) {
    rods.add(random_chain(random, nodes, edge_length), 0.01, random_section(random));
  }
  return rods;
}

/// Moves each node by up to a distance along each axis, and turns each edge by up to an angle.
inline void displace(Rods& rods, Random& random, double distance, double angle = 0.0) {
  for (Eigen::Vector3d& position : rods.positions) {
    position += random.in_cube(distance);
  }
  for (double& a : rods.angles) {
    a += random.uniform(-angle, angle);
  }
}

inline void give_velocities(Rods& rods, Random& random, double speed) {
  for (Eigen::Vector3d& velocity : rods.velocities) {
    velocity = random.in_cube(speed);
  }
}

/// Kinetic energy of a rod's nodes and of its edges' spins [J]; of a rigid part, that of a bar
/// whose velocity changes evenly from end to end.
inline double kinetic_energy(const Rods& rods, std::uint32_t rod) {
  double energy = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    energy += 0.5 * rods.masses[i] * rods.velocities[i].squaredNorm();
    if (rods.is_rigid(i)) {
      const double mass = 6.0 * rods.mass_couplings[i];
      const Eigen::Vector3d first = rods.velocities[i];
      const Eigen::Vector3d last = rods.velocities[i + 1];
      energy += mass / 6.0 * (first.squaredNorm() + first.dot(last) + last.squaredNorm());
      energy -= mass / 4.0 * (first.squaredNorm() + last.squaredNorm());
    }
  }
  for (std::uint32_t i = rods.first(rod); i + 1 < rods.end(rod) && !rods.spins.empty(); ++i) {
    energy += 0.5 * rods.sections[rod].inertia_per_length * rods.rest_lengths[i] * rods.spins[i] *
              rods.spins[i];
  }
  return energy;
}

/// Kinetic energy of all rods [J].
inline double kinetic_energy(const Rods& rods) {
  double energy = 0.0;
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    energy += kinetic_energy(rods, rod);
  }
  return energy;
}

}  // namespace fiber::test
