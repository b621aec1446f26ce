#pragma once

#include <array>

#include "src/sim/contact/barrier.hpp"

namespace fiber {

/// The barrier of an edge that has only a part of its weight, as its ends have barriers of their
/// own: the weight is the product of ramps, each of how much further an end is than the edge.
/// @returns [J], infinite where what is felt reaches the inner distance
inline double weighted_energy(const Barrier& barrier, double distance, double weight) {
  return weight * barrier.energy(barrier.felt(distance, weight));
}

/// Its derivatives by the distance and, as they change the weight, by those of the ends.
template <std::size_t ends>
struct WeightedSlopes {
  /// @param ramps   of each end, in parts of the barrier's width
  /// @param cosines of the angles between the normals at ends and the edge's
  WeightedSlopes(const Barrier& barrier, double distance, double weight,
                 const std::array<Ramp, ends>& ramps, const std::array<double, ends>& cosines) {
    const double felt = barrier.felt(distance, weight);
    const double by_felt = weight * barrier.slope(felt);
    const double by_felt_twice = weight * barrier.curvature(felt);
    const double depth_share = Barrier::depth_share(weight);
    const double by_weight =
        barrier.energy(felt) - by_felt * Barrier::most_relief * (barrier.outer - distance);
    slope = by_felt * depth_share;
    pressure = -slope;
    // How what is felt changes with the distance, and with those of the ends, by the weight.
    const double relief = Barrier::most_relief * (barrier.outer - distance);
    std::array<double, ends> felt_by_end{};
    double felt_by_ends = 0.0;
    for (std::size_t end = 0; end < ends; ++end) {
      if (ramps[end].slope > 0.0) {
        const double weight_by_end = weight / ramps[end].value * ramps[end].slope / barrier.width();
        felt_by_end[end] = relief * weight_by_end;
        felt_by_ends += felt_by_end[end];
        end_slopes[end] = by_weight * weight_by_end;
        slope -= end_slopes[end];
        // What an end takes back is not along the same normal.
        pressure += end_slopes[end] * (1.0 - cosines[end]);
      }
    }
    // The square of the sum of these is no more than this sum of squares.
    const double of_distance = depth_share + felt_by_ends;
    const double all = of_distance + felt_by_ends;
    curvature = by_felt_twice * of_distance * all;
    for (std::size_t end = 0; end < ends; ++end) {
      end_curvatures[end] = by_felt_twice * felt_by_end[end] * all;
    }
  }

  double slope;      ///< [N]
  double curvature;  ///< a positive part [N/m]
  double pressure;   ///< see DistanceTerm [N]
  std::array<double, ends> end_slopes{};
  std::array<double, ends> end_curvatures{};
};

}  // namespace fiber
