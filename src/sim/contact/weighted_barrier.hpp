#pragma once

#include <array>
#include <cstddef>

#include "src/sim/contact/barrier.hpp"

namespace fiber {

/// Derivatives of a WeightedBarrier by the edge's distance and, as they change the weight, by those
/// of its ends.
template <std::size_t ends>
struct WeightedSlopes {
  double slope = 0.0;      ///< [N]
  double curvature = 0.0;  ///< a positive part [N/m]
  double pressure = 0.0;   ///< see DistanceTerm [N]
  std::array<double, ends> end_slopes{};
  std::array<double, ends> end_curvatures{};
};

/// The barrier of an edge that has only a part of its weight, as its ends have barriers of their
/// own: the weight is the product of ramps, each of how much further an end is than the edge.
class WeightedBarrier {
 public:
  /// @param barrier must outlive this
  WeightedBarrier(const Barrier& barrier, double distance, double weight)
      : barrier_(barrier),
        distance_(distance),
        weight_(weight),
        felt_(barrier.felt(distance, weight)),
        energy_(barrier.energy(felt_)) {}

  /// @returns [J], infinite where what is felt reaches the inner distance
  double energy() const { return weight_ * energy_; }

  /// Where the energy is finite.
  /// @param ramps   of each end, in parts of the barrier's width
  /// @param cosines of the angles between the normals at ends and the edge's
  template <std::size_t ends>
  WeightedSlopes<ends> slopes(const std::array<Ramp, ends>& ramps,
                              const std::array<double, ends>& cosines) const {
    const double by_felt = weight_ * barrier_.slope(felt_);
    const double by_felt_twice = weight_ * barrier_.curvature(felt_);
    const double depth_share = Barrier::depth_share(weight_);
    const double by_weight =
        energy_ - by_felt * Barrier::most_relief * (barrier_.outer - distance_);
    WeightedSlopes<ends> found;
    found.slope = by_felt * depth_share;
    found.pressure = -found.slope;
    // How what is felt changes with the distance, and with those of the ends, by the weight.
    const double relief = Barrier::most_relief * (barrier_.outer - distance_);
    std::array<double, ends> felt_by_end{};
    double felt_by_ends = 0.0;
    for (std::size_t end = 0; end < ends; ++end) {
      if (ramps[end].slope > 0.0) {
        const double weight_by_end =
            weight_ / ramps[end].value * ramps[end].slope / barrier_.width();
        felt_by_end[end] = relief * weight_by_end;
        felt_by_ends += felt_by_end[end];
        found.end_slopes[end] = by_weight * weight_by_end;
        found.slope -= found.end_slopes[end];
        // What an end takes back is not along the same normal.
        found.pressure += found.end_slopes[end] * (1.0 - cosines[end]);
      }
    }
    // The square of the sum of these is no more than this sum of squares.
    const double of_distance = depth_share + felt_by_ends;
    const double all = of_distance + felt_by_ends;
    found.curvature = by_felt_twice * of_distance * all;
    for (std::size_t end = 0; end < ends; ++end) {
      found.end_curvatures[end] = by_felt_twice * felt_by_end[end] * all;
    }
    return found;
  }

 private:
  const Barrier& barrier_;
  double distance_;  // [m]
  double weight_;    // in [0, 1]
  double felt_;      // [m]
  double energy_;    // [J] of the whole weight
};

}  // namespace fiber
