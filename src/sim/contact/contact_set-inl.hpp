#pragma once

#include <vector>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

inline Eigen::Vector3d point_at(const std::vector<Eigen::Vector3d>& of_nodes, std::uint32_t edge,
                                double parameter) {
  return (1.0 - parameter) * of_nodes[edge] + parameter * of_nodes[edge + 1];
}

/// Calls function(points, term, barrier) for what the contact has of the energy.
/// @param found room for these terms
template <class Function>
void ContactSet::visit_obstacle(std::size_t index, std::vector<DistanceTerm>& found,
                                const Function& function) const {
  const ObstacleContact& contact = obstacle_contacts[index];
  found.clear();
  obstacle_contact(contact, obstacle_distances_[index], &found);
  for (const DistanceTerm& term : found) {
    function(PointPair{contact.rod, contact.edge, term.s, contact.piece.object(), no_edge, 0.0},
             term, contact.barrier);
  }
}

/// The same of a pair.
template <class Function>
void ContactSet::visit_pair(const Rods& rods, std::size_t index, std::vector<DistanceTerm>& found,
                            const Function& function) const {
  const EdgePair& pair = pairs[index];
  if (distances_[index].distance >= pair.barrier.outer) {
    return;
  }
  found.clear();
  edge_contact(pair, rods.positions, distances_[index], &found);
  for (const DistanceTerm& term : found) {
    function(PointPair{pair.rod_a, pair.edge_a, term.s, pair.rod_b, pair.edge_b, term.t}, term,
             pair.barrier);
  }
}

/// The same of either, obstacles first.
template <class Function>
void ContactSet::visit(const Rods& rods, std::size_t index, std::vector<DistanceTerm>& found,
                       const Function& function) const {
  if (index < obstacle_contacts.size()) {
    visit_obstacle(index, found, function);
  } else {
    visit_pair(rods, index - obstacle_contacts.size(), found, function);
  }
}

template <class Function>
void ContactSet::for_each_distance(const Rods& rods, const Function& function) const {
  std::vector<DistanceTerm> found;
  for (std::size_t i = 0; i < distance_count(); ++i) {
    visit(rods, i, found, function);
  }
}

}  // namespace fiber
