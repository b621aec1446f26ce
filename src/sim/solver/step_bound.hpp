#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
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
  void begin(const Room* room, std::uint32_t islands) {
    room_ = room;
    progress_.assign(islands, 0.0);
    rates_.assign(islands, 0.0);
    needed_.clear();
  }

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
             std::vector<Eigen::Vector3d>& ends) {
    contacts.bound_step(rods, displacements, islands, shares, ends);
    // Which part of the expected ways a step is, by least squares.
    std::vector<double> along(shares.size(), 0.0);
    std::vector<double> squares(shares.size(), 0.0);
    for (const std::uint32_t rod : members) {
      for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
        along[islands[rod]] += displacements[i].dot(room_->expected[i]);
        squares[islands[rod]] += room_->expected[i].squaredNorm();
      }
    }
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const double rate = squares[k] > 0.0 ? along[k] / squares[k] : 0.0;
      rates_[k] = std::clamp(progress_[k] + rate, 0.0, 1.0) - progress_[k];
    }
    bool has_room = true;
    for (const std::uint32_t rod : members) {
      const std::uint32_t k = islands[rod];
      const double room = room_->by_rod[rod];
      const double after =
          deviation(rods, rod, progress_[k] + shares[k] * rates_[k], &displacements, shares[k]);
      if (after <= room) {
        continue;
      }
      if (!room_->is_last) {
        require(rod, after);
        has_room = false;
        continue;
      }
      // The deviation is a convex function of the share.
      const double before = deviation(rods, rod, progress_[k], nullptr, 0.0);
      shares[k] *= std::max(0.0, room - before) / (after - before);
    }
    return has_room;
  }

  /// Shares of it have been gone.
  void advance(const std::vector<double>& shares) {
    for (std::size_t k = 0; k < shares.size(); ++k) {
      progress_[k] += shares[k] * rates_[k];
    }
  }

  /// Whether the rods are within their rooms about the ends of their expected ways.
  bool is_within(const Rods& rods, const std::vector<std::uint32_t>& members) {
    bool is_within = true;
    for (const std::uint32_t rod : members) {
      const double off = deviation(rods, rod, 1.0, nullptr, 0.0);
      if (off > room_->by_rod[rod]) {
        require(rod, off);
        is_within = false;
      }
    }
    return is_within;
  }

  /// By which the rods have been off, or would have been [m].
  const std::vector<std::pair<std::uint32_t, double>>& needed() const { return needed_; }

 private:
  /// The largest distance of a rod's nodes from a part of their expected ways [m], when a share of
  /// some displacements is gone.
  double deviation(const Rods& rods, std::uint32_t rod, double progress,
                   const std::vector<Eigen::Vector3d>* displacements, double share) const {
    double largest = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      Eigen::Vector3d off = rods.positions[i] - room_->start[i] - progress * room_->expected[i];
      if (displacements != nullptr) {
        off += share * (*displacements)[i];
      }
      largest = std::max(largest, off.squaredNorm());
    }
    return std::sqrt(largest);
  }

  void require(std::uint32_t rod, double room) {
    constexpr double spare = 1.5;
    needed_.emplace_back(rod, spare * room);
  }

  const Room* room_ = nullptr;
  std::vector<double> progress_;  // along the expected ways, by island
  std::vector<double> rates_;     // how a whole step changes that
  std::vector<std::pair<std::uint32_t, double>> needed_;
};

}  // namespace fiber
