#pragma once

#include <vector>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

/// How far nodes may go in a step, as contacts were looked for within that. A node may be off a
/// share of its expected way by as much as its rod has room, the share being the same for all rods:
/// what moves as expected, be it ever so fast, needs no room.
struct Room {
  std::vector<Eigen::Vector3d> start;     ///< of the step, by node [m]
  std::vector<Eigen::Vector3d> expected;  ///< ways, by node [m]
  std::vector<double> by_rod;             ///< [m]

  /// There is no more room: a step goes no further. Otherwise rods that need more of it are to
  /// begin the step again.
  bool is_last = false;
};

/// The one bound on how far Newton's step goes, by island: no contact's distance falls below a
/// fifth of what it has, and no rod leaves its room.
class StepBound {
 public:
  /// Room that a rod should have at the least, in parts of its radius.
  static constexpr double least_room = 0.25;

  /// @param room null for none
  void begin(const Room* room, std::uint32_t islands);

  /// Bounds a step.
  /// @param displacements by the whole step, of nodes [m]
  /// @param members       rods
  /// @param islands       by rod
  /// @param shares        of the step, by island: shortened
  /// @param ends          room for a position of each node
  /// @returns false if a rod needs more room
  bool bound(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
             const std::vector<std::uint32_t>& members, const std::vector<std::uint32_t>& islands,
             const ContactSet& contacts, std::vector<double>& shares,
             std::vector<Eigen::Vector3d>& ends);

  /// Shares of it have been gone.
  void advance(const std::vector<double>& shares);

  /// Whether the rods are within their rooms about the ends of their expected ways.
  bool is_within(const Rods& rods, const std::vector<std::uint32_t>& members);

  /// By which the rods have been off, or would have been [m].
  const std::vector<std::pair<std::uint32_t, double>>& needed() const { return needed_; }

 private:
  double deviation(const Rods& rods, std::uint32_t rod, double progress,
                   const std::vector<Eigen::Vector3d>* displacements, double share) const;
  void require(std::uint32_t rod, double room);

  const Room* room_ = nullptr;
  std::vector<double> progress_;  // along the expected ways, by island
  std::vector<double> rates_;     // how a whole step changes that
  std::vector<std::pair<std::uint32_t, double>> needed_;
};

}  // namespace fiber
