#pragma once

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

#include "src/sim/contact/contact_set.hpp"

namespace fiber {

/// How far nodes may go in a step: contacts were looked for within that. The solve may bring an
/// island any share of the expected displacements; beside that, a node may deviate by its rod's
/// bound. Rods that move as expected, however fast, need no bound.
struct TravelBound {
  std::vector<Eigen::Vector3d> start;     ///< of the step, by node [m]
  std::vector<Eigen::Vector3d> expected;  ///< displacements, by node [m]
  std::vector<double> by_rod;             ///< largest deviation [m]

  /// The bound does not grow any more: steps are shortened to stay within it. Otherwise, the step
  /// of rods that need a wider bound is solved again with that.
  bool is_final = false;
};

/// The one bound on how far Newton's step goes, by island: no contact's distance falls below a
/// fifth of what it has, and no rod leaves its travel bound.
class StepBound {
 public:
  /// Least travel bound of a rod, in parts of its radius.
  static constexpr double min_travel = 0.25;

  /// @param travel_bound null for none
  void begin(const TravelBound* travel_bound, std::uint32_t islands) {
    travel_bound_ = travel_bound;
    progress_.assign(islands, 0.0);
    rates_.assign(islands, 0.0);
    needed_.clear();
  }

  /// Bounds a step.
  /// @param displacements by the whole step, of nodes [m]
  /// @param members       rods
  /// @param islands       by rod
  /// @param shares        of the step, by island: shortened
  /// @param ends          buffer for a position of each node
  /// @returns false if a rod needs a wider travel bound
  bool bound(const Rods& rods, const std::vector<Eigen::Vector3d>& displacements,
             const std::vector<std::uint32_t>& members, const std::vector<std::uint32_t>& islands,
             const ContactSet& contacts, std::vector<double>& shares,
             std::vector<Eigen::Vector3d>& ends) {
    contacts.bound_step(rods, displacements, islands, shares, ends);
    // The part of the expected displacements that a step is, by least squares.
    along_.assign(shares.size(), 0.0);
    squares_.assign(shares.size(), 0.0);
    for (const std::uint32_t rod : members) {
      for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
        along_[islands[rod]] += displacements[i].dot(travel_bound_->expected[i]);
        squares_[islands[rod]] += travel_bound_->expected[i].squaredNorm();
      }
    }
    for (std::size_t k = 0; k < shares.size(); ++k) {
      const double rate = squares_[k] > 0.0 ? along_[k] / squares_[k] : 0.0;
      rates_[k] = std::clamp(progress_[k] + rate, 0.0, 1.0) - progress_[k];
    }
    bool is_within_bound = true;
    for (const std::uint32_t rod : members) {
      const std::uint32_t k = islands[rod];
      const double travel_bound = travel_bound_->by_rod[rod];
      const double after =
          deviation(rods, rod, progress_[k] + shares[k] * rates_[k], &displacements, shares[k]);
      if (after <= travel_bound) {
        continue;
      }
      if (!travel_bound_->is_final) {
        request(rod, after);
        is_within_bound = false;
        continue;
      }
      // The deviation is a convex function of the share.
      const double before = deviation(rods, rod, progress_[k], nullptr, 0.0);
      shares[k] *= std::max(0.0, travel_bound - before) / (after - before);
    }
    return is_within_bound;
  }

  /// Adds shares of the bounded step, which the rods have gone, to their progress.
  void advance(const std::vector<double>& shares) {
    for (std::size_t k = 0; k < shares.size(); ++k) {
      progress_[k] += shares[k] * rates_[k];
    }
  }

  /// Whether the rods are within their bounds about the ends of their expected displacements.
  bool is_within(const Rods& rods, const std::vector<std::uint32_t>& members) {
    bool is_within = true;
    for (const std::uint32_t rod : members) {
      const double off = deviation(rods, rod, 1.0, nullptr, 0.0);
      if (off > travel_bound_->by_rod[rod]) {
        request(rod, off);
        is_within = false;
      }
    }
    return is_within;
  }

  /// The rods that need a wider travel bound, and that bound [m].
  const std::vector<std::pair<std::uint32_t, double>>& needed() const { return needed_; }

 private:
  /// The largest distance of a rod's nodes from a part of their expected displacements [m], after
  /// a share of some displacements.
  double deviation(const Rods& rods, std::uint32_t rod, double progress,
                   const std::vector<Eigen::Vector3d>* displacements, double share) const {
    double largest = 0.0;
    for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
      Eigen::Vector3d off =
          rods.positions[i] - travel_bound_->start[i] - progress * travel_bound_->expected[i];
      if (displacements != nullptr) {
        off += share * (*displacements)[i];
      }
      largest = std::max(largest, off.squaredNorm());
    }
    return std::sqrt(largest);
  }

  void request(std::uint32_t rod, double deviation) {
    constexpr double margin = 1.5;
    needed_.emplace_back(rod, margin * deviation);
  }

  const TravelBound* travel_bound_ = nullptr;
  std::vector<double> progress_;  // along the expected displacements, by island
  std::vector<double> rates_;     // change of the progress by a whole step
  std::vector<std::pair<std::uint32_t, double>> needed_;
  std::vector<double> along_;    // buffer: by island
  std::vector<double> squares_;  // buffer: by island
};

}  // namespace fiber
