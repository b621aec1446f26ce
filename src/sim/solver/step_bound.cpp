#include "src/sim/solver/step_bound.hpp"

#include <algorithm>
#include <cmath>

namespace fiber {

using Eigen::Vector3d;

void StepBound::begin(const Room* room, std::uint32_t islands) {
  room_ = room;
  progress_.assign(islands, 0.0);
  rates_.assign(islands, 0.0);
  needed_.clear();
}

/// The largest distance of a rod's nodes from a part of their expected ways [m], when a share of
/// some displacements is gone.
double StepBound::deviation(const Rods& rods, std::uint32_t rod, double progress,
                            const std::vector<Vector3d>* displacements, double share) const {
  double largest = 0.0;
  for (std::uint32_t i = rods.first(rod); i < rods.end(rod); ++i) {
    Vector3d off = rods.positions[i] - room_->start[i] - progress * room_->expected[i];
    if (displacements != nullptr) {
      off += share * (*displacements)[i];
    }
    largest = std::max(largest, off.squaredNorm());
  }
  return std::sqrt(largest);
}

void StepBound::require(std::uint32_t rod, double room) {
  constexpr double spare = 1.5;
  needed_.emplace_back(rod, spare * room);
}

bool StepBound::bound(const Rods& rods, const std::vector<Vector3d>& displacements,
                      const std::vector<std::uint32_t>& members,
                      const std::vector<std::uint32_t>& islands, const ContactSet& contacts,
                      std::vector<double>& shares, std::vector<Vector3d>& ends) {
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

void StepBound::advance(const std::vector<double>& shares) {
  for (std::size_t k = 0; k < shares.size(); ++k) {
    progress_[k] += shares[k] * rates_[k];
  }
}

bool StepBound::is_within(const Rods& rods, const std::vector<std::uint32_t>& members) {
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

}  // namespace fiber
