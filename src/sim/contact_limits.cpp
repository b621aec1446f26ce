#include "fiber_proximity/sim/contact_limits.hpp"

#include <algorithm>

namespace fiber {

double fastest_speed(const Rods& rods) {
  double fastest = 0.0;
  for (const Eigen::Vector3d& velocity : rods.velocities) {
    fastest = std::max(fastest, velocity.norm());
  }
  return fastest;
}

double longest_move(const Rods& rods, double fastest) {
  constexpr double edges = 8.0;
  constexpr double steps = 4.0;
  return edges * *std::max_element(rods.rest_lengths.begin(), rods.rest_lengths.end()) +
         steps * fastest;
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
