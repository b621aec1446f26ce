#pragma once

#include <cstdint>
#include <vector>

#include "src/sim/contact/edge_contact.hpp"

namespace fiber {

/// Which edges are too near each other along the rods to be in contact. Where rods are closed or
/// joined, that is along the shortest way: edges that meet at a joint are never in contact, nor are
/// those with less than four mean radii of the two rods between them. One thread at a time.
class ContactNeighbours {
 public:
  ContactNeighbours() = default;
  explicit ContactNeighbours(const Rods& rods);

  /// @param rods that this was made of, wherever they are now; edges are counted as Rods does
  bool contain(const Rods& rods, std::uint32_t rod_a, std::uint32_t edge_a, std::uint32_t rod_b,
               std::uint32_t edge_b) const {
    return (rod_a == rod_b && are_contact_neighbours(rods, arcs_, rod_a, edge_a, edge_b)) ||
           (!members_.empty() && are_near_by_joints(rods, rod_a, edge_a, rod_b, edge_b));
  }

 private:
  bool are_near_by_joints(const Rods& rods, std::uint32_t rod_a, std::uint32_t edge_a,
                          std::uint32_t rod_b, std::uint32_t edge_b) const;
  bool is_near(const Rods& rods, std::uint32_t from, double limit, std::uint32_t rod_b,
               std::uint32_t edge_b) const;

  std::vector<double> arcs_;                         // along each rod at rest, by node [m]
  std::vector<std::uint32_t> rods_;                  // by node, if there are joints
  std::vector<std::vector<std::uint32_t>> members_;  // nodes, by joint

  // By edge, if there are joints: along its rod to the nearest one; infinite without one [m].
  std::vector<double> to_joint_;

  /// A node that is come to by a joint, and the length that is left from there.
  struct Arrival {
    std::uint32_t node;
    double left;  // [m]
  };
  mutable std::vector<Arrival> arrivals_;         // of is_near()
  mutable std::vector<double> left_;              // the same: the most that was left at each joint
  mutable std::vector<std::uint32_t> come_upon_;  // the joints that it has set
};

}  // namespace fiber
