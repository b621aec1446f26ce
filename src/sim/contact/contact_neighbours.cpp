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
  return is_near(rods, edge_a, limit, rod_b, edge_b);
}

/// Whether there is less than a length between two edges, by way of one joint or more: the shortest
/// way, where each joint is left again only with more of the length than before.
/// @param limit [m]
bool ContactNeighbours::is_near(const Rods& rods, std::uint32_t from, double limit,
                                std::uint32_t rod_b, std::uint32_t edge_b) const {
  left_.resize(members_.size(), 0.0);
  arrivals_.clear();
  const auto leave_by_joints_from = [&](std::uint32_t node, double left) {
    const auto leave_at = [&](std::uint32_t at) {
      const double rest = left - std::abs(arcs_[at] - arcs_[node]);
      if (rods.joints[at] < 0) {
        return;
      }
      const auto joint = static_cast<std::uint32_t>(rods.joints[at]);
      if (rest > left_[joint]) {
        left_[joint] = rest;
        come_upon_.push_back(joint);
        for (const std::uint32_t other : members_[joint]) {
          if (other != at) {
            arrivals_.push_back({other, rest});
          }
        }
      }
    };
    const std::uint32_t rod = rods_[node];
    for (std::uint32_t at = node; at < rods.end(rod) && arcs_[at] - arcs_[node] < left; ++at) {
      leave_at(at);
    }
    for (std::uint32_t at = node; at-- > rods.first(rod) && arcs_[node] - arcs_[at] < left;) {
      leave_at(at);
    }
  };
  leave_by_joints_from(from, limit);
  leave_by_joints_from(from + 1, limit);
  bool is_found = false;
  while (!is_found && !arrivals_.empty()) {
    const Arrival arrival = arrivals_.back();
    arrivals_.pop_back();
    const double at = arcs_[arrival.node];
    is_found =
        rods_[arrival.node] == rod_b &&
        std::min(std::abs(at - arcs_[edge_b]), std::abs(at - arcs_[edge_b + 1])) < arrival.left;
    leave_by_joints_from(arrival.node, arrival.left);
  }
  for (const std::uint32_t joint : come_upon_) {
    left_[joint] = 0.0;
  }
  come_upon_.clear();
  return is_found;
}

}  // namespace fiber
