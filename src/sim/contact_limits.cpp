#include "fiber_proximity/sim/contact_limits.hpp"

#include <algorithm>
#include <cmath>

namespace fiber {

double contact_neighbour_length(const Rods& rods) {
  return 4.0 * *std::max_element(rods.radii.begin(), rods.radii.end());
}

bool are_contact_neighbours(const Rods& rods, std::uint32_t edge_a, std::uint32_t edge_b) {
  const double least = contact_neighbour_length(rods);
  double between = 0.0;
  for (std::uint32_t i = edge_a + 1; i < edge_b && between < least; ++i) {
    between += rods.rest_lengths[i];
  }
  return between < least;
}

double largest_square(const std::vector<Eigen::Vector3d>& vectors) {
  double largest = 0.0;
  for (const Eigen::Vector3d& vector : vectors) {
    largest = std::max(largest, vector.squaredNorm());
  }
  return largest;
}

double longest_move(const Rods& rods, double fastest) {
  constexpr double edges = 8.0;
  constexpr double steps = 4.0;
  return edges * *std::max_element(rods.rest_lengths.begin(), rods.rest_lengths.end()) +
         steps * fastest;
}

Eigen::Vector3d mean_move(const std::vector<Eigen::Vector3d>& from,
                          const std::vector<Eigen::Vector3d>& now,
                          const std::vector<Eigen::Vector3d>& displacements) {
  Eigen::Vector3d sum = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < now.size(); ++i) {
    sum += now[i] + displacements[i] - from[i];
  }
  return sum / static_cast<double>(now.size());
}

double farthest_move(const std::vector<Eigen::Vector3d>& from,
                     const std::vector<Eigen::Vector3d>& now,
                     const std::vector<Eigen::Vector3d>& displacements,
                     const Eigen::Vector3d& drift) {
  double farthest_square = 0.0;
  for (std::size_t i = 0; i < now.size(); ++i) {
    farthest_square =
        std::max(farthest_square, (now[i] + displacements[i] - from[i] - drift).squaredNorm());
  }
  return std::sqrt(farthest_square);
}

void limit_length(double most, Eigen::Vector3d& displacement) {
  const double length = displacement.norm();
  if (length > std::max(0.0, most)) {
    displacement *= std::max(0.0, most) / length;
  }
}

bool limit_approach(const Eigen::Vector3d& towards, double most, Eigen::Vector3d& displacement) {
  const double approach = towards.dot(displacement);
  if (!(approach > std::max(0.0, most))) {
    return false;
  }
  displacement *= std::max(0.0, most) / approach;
  return true;
}

}  // namespace fiber
