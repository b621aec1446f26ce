#include "src/sim/contact/contact_neighbours.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace fiber {

ContactNeighbours::ContactNeighbours(const Rods& rods) : arcs_(contact_arcs(rods)) {
  if (rods.joints.empty()) {
    return;
  }
  rods_.resize(rods.positions.size());
  for (std::uint32_t rod = 0; rod < rods.count(); ++rod) {
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      rods_[i] = rod;
      if (rods.joints[i] >= 0) {
        const auto joint = static_cast<std::size_t>(rods.joints[i]);
        members_.resize(std::max(members_.size(), joint + 1));
        members_[joint].push_back(i);
      }
    }
  }
  to_joint_.assign(rods.positions.size(), std::numeric_limits<double>::infinity());
  for (const std::vector<std::uint32_t>& members : members_) {
    for (const std::uint32_t node : members) {
      const std::uint32_t rod = rods_[node];
      for (std::uint32_t edge = rods.first(rod); edge + 1 < rods.end(rod); ++edge) {
        const double between =
            std::min(std::abs(arcs_[edge] - arcs_[node]), std::abs(arcs_[edge + 1] - arcs_[node]));
        to_joint_[edge] = std::min(to_joint_[edge], between);
      }
    }
  }
}

bool ContactNeighbours::are_near_by_joints(const Rods& rods, std::uint32_t rod_a,
                                           std::uint32_t edge_a, std::uint32_t rod_b,
                                           std::uint32_t edge_b) const {
  const double limit = contact_neighbour_length(rods, rod_a, edge_a, rod_b, edge_b);
  if (to_joint_[edge_a] + to_joint_[edge_b] >= limit) {
    return false;
  }
  return is_near(rods, edge_a, limit, rod_b, edge_b, false) ||
         is_near(rods, edge_a + 1, limit, rod_b, edge_b, false);
}

/// Whether there is less than a length between a node and an edge, by way of one joint or more.
/// @param limit     [m]
/// @param has_joint whether there was one before the node
bool ContactNeighbours::is_near(const Rods& rods, std::uint32_t node, double limit,
                                std::uint32_t rod_b, std::uint32_t edge_b, bool has_joint) const {
  const std::uint32_t rod = rods_[node];
  if (has_joint && rod == rod_b) {
    const double between =
        std::min(std::abs(arcs_[node] - arcs_[edge_b]), std::abs(arcs_[node] - arcs_[edge_b + 1]));
    if (between < limit) {
      return true;
    }
  }
  const auto leave_at = [&](std::uint32_t at) {
    if (rods.joints[at] < 0) {
      return false;
    }
    const double left = limit - std::abs(arcs_[at] - arcs_[node]);
    for (const std::uint32_t other : members_[static_cast<std::size_t>(rods.joints[at])]) {
      if (other != at && left > 0.0 && is_near(rods, other, left, rod_b, edge_b, true)) {
        return true;
      }
    }
    return false;
  };
  // From a joint the way goes on along the rod, not through the same joint again.
  for (std::uint32_t at = has_joint ? node + 1 : node;
       at < rods.end(rod) && arcs_[at] - arcs_[node] < limit; ++at) {
    if (leave_at(at)) {
      return true;
    }
  }
  for (std::uint32_t at = node; at-- > rods.first(rod) && arcs_[node] - arcs_[at] < limit;) {
    if (leave_at(at)) {
      return true;
    }
  }
  return false;
}

}  // namespace fiber
